"""One face: what becomes of a mistake of our own inside it."""

import logging

import cadquery as cq
import pytest

import surfmesh as sm
from surfmesh.errors import MeshingError, SurfaceError
from surfmesh.meshing.faces import face_mesh, face_queue


@pytest.fixture(autouse=True)
def none_by_the_core(monkeypatch):
    """Every face is meshed by ``mesh_face`` from its beginning."""
    monkeypatch.setattr(face_queue.CoreFaces, "face", lambda *_: None)


def test_an_internal_error_leaves_its_traceback_in_the_log(monkeypatch, caplog):
    def broken(job, **how):
        raise IndexError("no such slot")

    monkeypatch.setattr(face_mesh, "_meshed", broken)
    caplog.set_level(logging.DEBUG, "surfmesh")
    with pytest.raises(MeshingError, match=r"internal error, please report .* no such slot"):
        sm.mesh(cq.Workplane().box(1, 1, 1), 0.5)
    assert "in broken" in caplog.text and "IndexError: no such slot" in caplog.text


def refused_at_the_top(monkeypatch, mistake):
    """A unit box without its top, whose corners are where ``mistake`` of a job is raised."""
    real = face_mesh._meshed

    def broken(job, **how):
        if all(piece.points[:, 2].min() > 0.4 for loop in job.loops for piece in loop):
            raise mistake(job)
        return real(job, **how)

    monkeypatch.setattr(face_mesh, "_meshed", broken)
    model = sm.from_cadquery(cq.Workplane().box(1, 1, 1))
    mesh = sm.mesh(model, 0.5, strict=False)
    (found,) = mesh.findings
    assert found.text in mesh.warnings and found.label == model.face_label(found.face)
    assert found.kind.name == "NOT_MESHED" and found.face not in mesh.face_ids
    return found


def test_missing_faces_are_findings_with_their_number(monkeypatch):
    found = refused_at_the_top(monkeypatch, lambda job: IndexError("no such slot"))
    assert found.place is None


def test_a_missing_face_says_where_it_failed(monkeypatch):
    def crossing(job):
        error = SurfaceError("segments cross")
        error.where = job.loops[0][0].uv[:2]
        return error

    monkeypatch.setattr(face_mesh, "untangled_job", lambda job: None)
    monkeypatch.setattr(face_mesh, "filled_face", lambda job, reason: None)
    found = refused_at_the_top(monkeypatch, crossing)
    assert [abs(x) for x in found.place] == pytest.approx([0.5, 0.5, 0.5])
