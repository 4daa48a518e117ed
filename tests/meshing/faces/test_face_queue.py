"""Ordinary faces meshed by the core in a queue: each as it is by itself."""

import pickle
from dataclasses import replace
from threading import Thread

import cadquery as cq
import numpy as np
import pytest

import surfmesh as sm
from surfmesh._core import faces as core
from surfmesh.meshing.estimate.unmeshed_model import UnmeshedModel
from surfmesh.meshing.faces import face_queue
from surfmesh.meshing.faces.face_data import FaceMesh
from surfmesh.meshing.faces.face_mesh import mesh_face
from surfmesh.meshing.faces.face_queue import FaceQueue
from surfmesh.meshing.faces.face_workers import FaceWorkers
from surfmesh.meshing.faces.inward_faces import inward_face
from surfmesh.sizing.options.sizing import Sizing
from surfmesh.sizing.rules.size_rules import asked_rules

ARRAYS = ("points", "slots", "triangles", "uv_points", "uv_triangles", "sizes")


def jobs_of(part, sizing):
    return UnmeshedModel(sm.from_cadquery(part), sizing).jobs


def plate():
    """Planes and cylinders, a cone and a sphere."""
    body = cq.Workplane().box(6, 4, 1).faces(">Z").workplane()
    body = body.pushPoints([(-2, 0)]).hole(1).pushPoints([(2, 0)]).cskHole(0.6, 1.4, 82)
    return body.union(cq.Workplane().sphere(0.6).translate((0, 0, 0.5)))


@pytest.fixture(scope="module")
def jobs():
    return jobs_of(plate(), 0.4)


def worked(queue, at_once=10_000):
    found = {}
    while made := queue.work(at_once):
        found.update(made)
    return found


def require_same(one, other):
    for name in ARRAYS:
        first, second = getattr(one, name), getattr(other, name)
        assert first.tobytes() == second.tobytes() and first.shape == second.shape, name
    assert (one.failure, one.remark) == (other.failure, other.remark)
    assert (one.refinement is None) == (other.refinement is None)
    if one.refinement is not None:
        assert np.array_equal(one.refinement.sizes, other.refinement.sizes)


def test_the_queue_meshes_as_face_by_face(jobs):
    queue = FaceQueue(jobs, range(len(jobs)))
    made = worked(queue)
    kinds = {jobs[k].surface.kind for k in made}
    assert kinds == {"plane", "cylinder", "cone"}
    assert "sphere" in {jobs[k].surface.kind for k in queue.left}
    assert sorted([*made, *queue.left]) == list(range(len(jobs)))
    for number, mesh in made.items():
        require_same(mesh, mesh_face(jobs[number]))


def test_what_asks_for_smaller_sizes_goes_on_in_python(jobs):
    """Edges far longer than the sizes inside: a cylinder whose circles are cut for a plane."""
    asking = jobs_of(cq.Workplane().circle(2).extrude(3), sm.Sizing(angle=4, growth=3.0))
    for some in (jobs, asking):
        for number, mesh in worked(FaceQueue(some, range(len(some)))).items():
            require_same(mesh, mesh_face(some[number]))


def test_thin_tubes_are_left_to_who_knows_them():
    jobs = jobs_of(cq.Workplane().circle(0.1).extrude(5), 1.0)
    tube = next(k for k, job in enumerate(jobs) if job.surface.kind == "cylinder")
    begun = core.mesh_inward(inward_face(jobs[tube], look_for_tubes=True))
    assert begun.end == core.FaceEnd.TUBES
    require_same(worked(FaceQueue(jobs, [tube]))[tube], mesh_face(jobs[tube]))


def test_threads_share_a_queue(jobs):
    queue, alone = FaceQueue(jobs, range(len(jobs))), worked(FaceQueue(jobs, range(len(jobs))))
    found = [{}, {}, {}]
    threads = [Thread(target=lambda own=own: own.update(worked(queue, 1))) for own in found]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    assert sum(map(len, found)) == len(alone)
    for number, mesh in {k: mesh for own in found for k, mesh in own.items()}.items():
        require_same(mesh, alone[number])


def test_a_stopped_queue_begins_nothing(jobs):
    queue = FaceQueue(jobs, range(len(jobs)))
    assert len(queue.work(1)) == 1
    queue.stop()
    assert queue.work(1) == []


def test_what_goes_wrong_where_a_face_goes_on_comes_out(jobs, monkeypatch):
    def broken(job, begun):
        raise MemoryError("no room")

    monkeypatch.setattr(face_queue, "continued", broken)
    monkeypatch.setattr("surfmesh.meshing.faces.face_workers.LITTLE", 0)
    thin = jobs_of(cq.Workplane().circle(0.1).extrude(5), 1.0)
    with pytest.raises(MemoryError, match="no room"):
        dict(FaceWorkers(2).meshed(thin))


def test_faces_that_are_none_are_refused(jobs):
    pole = next(job for job in jobs if job.boundary.has_degenerate)
    asked, manner = asked_rules(Sizing(size=1.0)), core.FaceManner(None, None, 0.0)
    assert core.inward_face(pole.surface.core, pole.boundary, None, asked, 0.2, manner) is None
    flat = next(job for job in jobs if job.surface.kind == "plane")
    for radius, slope in ((0.0, 0.2), (None, float("nan"))):
        with pytest.raises(ValueError, match="positive"):
            core.inward_face(flat.surface.core, flat.boundary, radius, asked, slope, manner)
    with pytest.raises(TypeError):
        core.FaceQueue([None])


def test_a_face_in_rows_can_be_sent_and_stands_by_itself(jobs):
    for mesh in worked(FaceQueue(jobs, range(len(jobs)))).values():
        assert mesh.count == len(mesh.triangles) > 0 and not mesh.is_empty
        sent = pickle.loads(pickle.dumps(mesh))
        assert type(sent) is FaceMesh is type(mesh.whole())
        require_same(sent, mesh)
        assert replace(mesh.whole(), remark="seen").remark == "seen"
