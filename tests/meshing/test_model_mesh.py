"""CAD models: watertight by number, right topology, close to the true surfaces."""

import math

import cadquery as cq
import numpy as np
import pytest

import surfmesh as sm
from surfmesh.errors import MeshingError
from surfmesh.meshing.faces import face_queue, face_workers
from surfmesh.meshing.faces.face_data import FaceMesh
from surfmesh.quality.measures.solids import solid_mesh


def plate() -> cq.Workplane:
    return cq.Workplane().box(60, 40, 5).faces(">Z").workplane().rarray(15, 12, 3, 3).hole(6)


def letter() -> cq.Workplane:
    """An A: a counter inside, acute corners outside."""
    outside = [(0, 0), (4, 12), (6, 12), (10, 0), (8, 0), (7, 3), (3, 3), (2, 0)]
    inside = [(3.7, 5), (6.3, 5), (5, 9)]
    return cq.Workplane().polyline(outside).close().polyline(inside).close().extrude(2)


def add(solid: cq.Solid) -> cq.Workplane:
    return cq.Workplane().add(solid)


# Euler's number of the outside: 2 - 2 handles
PARTS = {
    "box": (lambda: cq.Workplane().box(10, 20, 30), 2),
    "plate": (plate, 2 - 2 * 9),
    "cylinder": (lambda: cq.Workplane().cylinder(20, 5), 2),
    "sphere": (lambda: cq.Workplane().sphere(5), 2),
    "cone": (lambda: add(cq.Solid.makeCone(5, 0, 10)), 2),
    "torus": (lambda: add(cq.Solid.makeTorus(10, 3)), 0),
    "fillets": (lambda: cq.Workplane().box(10, 20, 30).edges().fillet(2), 2),
    "shell": (lambda: cq.Workplane().box(10, 20, 30).faces(">Z").shell(-1), 2),
    "washer": (lambda: cq.Workplane().circle(20).circle(19.5).extrude(1), 0),
    "letter": (letter, 0),
    "pin": (lambda: cq.Workplane().circle(0.5).extrude(60), 2),  # chord is an eighth of its radius
}


@pytest.mark.parametrize("name", PARTS)
def test_parts_are_watertight_and_true(name):
    make, euler = PARTS[name]
    model = sm.from_cadquery(make())
    mesh = sm.mesh(model)
    report = sm.check(mesh)
    assert report.clean, report.problems
    assert report.closed and report.euler == euler
    assert report.area == pytest.approx(model.area, rel=0.025)
    assert report.volume == pytest.approx(model.volume, abs=mesh.sizing.chord * model.area)
    assert report.deviation_max <= mesh.sizing.chord
    assert report.above_chord_share in (None, 0.0) or report.above_chord_share < 1e-3
    assert report.alpha_mean > 0.9
    solid = mesh.to_trimesh()
    assert solid.is_watertight and solid.is_winding_consistent and solid.volume > 0.0


def test_mesh_edges_follow_cad_edges():
    model = sm.from_cadquery(plate())
    mesh = sm.mesh(model)
    length = np.linalg.norm(np.diff(mesh.points[mesh.edge_segments], axis=1)[:, 0], axis=1)
    for number, edge in enumerate(model.edges):
        found = length[mesh.edge_ids == number].sum()
        assert found == pytest.approx(edge.length, rel=0.05)
        assert found <= edge.length * (1.0 + 1e-12)
    corners = [vertex.point for vertex in model.vertices]
    assert np.array_equal(mesh.points[mesh.vertex_ids], corners)
    known = set(map(tuple, mesh.edges.tolist()))
    assert {tuple(sorted(pair)) for pair in mesh.edge_segments.tolist()} <= known


def test_shared_face_is_meshed_once():
    from OCP.BOPAlgo import BOPAlgo_Builder

    fuse = BOPAlgo_Builder()
    fuse.AddArgument(cq.Solid.makeBox(1, 1, 1).wrapped)
    fuse.AddArgument(cq.Solid.makeBox(2, 1, 1, cq.Vector(1, 0, 0)).wrapped)
    fuse.Perform()
    mesh = sm.mesh(sm.from_cadquery(cq.Shape.cast(fuse.Shape())), 0.4)
    report = sm.check(mesh)
    assert report.clean, report.problems
    assert report.volume == pytest.approx(3.0)
    assert (mesh.solid_ids >= 0).all(axis=1).any()
    for solid in (0, 1):
        assert sm.check(solid_mesh(mesh, solid)).closed


def test_uniform_size_and_callable():
    box = cq.Workplane().box(1, 1, 1)
    mesh = sm.mesh(box, 0.1)
    length = np.linalg.norm(np.diff(mesh.points[mesh.edges], axis=1)[:, 0], axis=1)
    assert length.mean() == pytest.approx(0.1, rel=0.1)
    finer = sm.mesh(box, lambda points: 0.04 + 0.1 * (points[:, 2] + 0.5))
    assert sm.check(finer).closed
    assert len(finer.triangles) > len(mesh.triangles)


def test_same_input_same_mesh():
    one, two = (sm.mesh(sm.from_cadquery(plate())) for _ in range(2))
    assert np.array_equal(one.points, two.points)
    assert np.array_equal(one.triangles, two.triangles)


def test_faces_that_fail_are_named(monkeypatch):
    model = sm.from_cadquery(cq.Workplane().box(1, 2, 3))
    work, top = face_workers.mesh_face, model.faces[2].surface

    def failing(job):
        return FaceMesh(failure="no luck") if job.surface is top else work(job)

    monkeypatch.setattr(face_workers, "mesh_face", failing)
    monkeypatch.setattr(face_queue.CoreFaces, "face", lambda *_: None)
    with pytest.raises(MeshingError, match=r"1 of 6 faces .* face 2 .*no luck"):
        sm.mesh(model, 0.5)
    mesh = sm.mesh(model, 0.5, strict=False)
    assert sorted(set(mesh.face_ids.tolist())) == [0, 1, 3, 4, 5]
    report = sm.check(mesh)
    assert not report.clean and not report.closed
    assert any("face 2" in problem for problem in report.problems)


def test_turned_faces_look_outwards():
    tube = cq.Workplane().circle(3).circle(2).extrude(5)
    mesh = sm.mesh(tube)
    assert mesh.turned_faces.any()
    assert sm.check(mesh).volume == pytest.approx(5 * math.pi * 5, rel=0.01)


def test_step_file_on_the_command_line(tmp_path):
    from surfmesh.cli import main

    part, out = tmp_path / "part.step", tmp_path / "part.vtu"
    cq.exporters.export(cq.Workplane().box(1, 2, 3).faces(">Z").workplane().hole(0.5), str(part))
    assert main(["mesh", str(part), "-o", str(out), "--max-size", "0.5"]) == 0
    assert out.exists()


def test_a_bore_finer_than_min_size_stays_open():
    """Its side is a tube of a few triangles round: it was closed at both ends instead."""
    bored = cq.Workplane().box(10, 10, 10).faces(">Z").workplane().hole(0.2)
    mesh = sm.mesh(sm.from_cadquery(bored), sm.Sizing(size=2.0, min_size=1.0))
    report = sm.check(mesh)
    assert report.closed and report.manifold and report.euler == 0


def test_the_number_of_workers_changes_nothing():
    model = sm.from_cadquery(plate())
    one, three = (sm.mesh(model, jobs=jobs) for jobs in (1, 3))
    assert np.array_equal(one.points, three.points)
    assert np.array_equal(one.triangles, three.triangles)


def test_a_chord_of_one_face_is_not_an_edge_of_others():
    """A ring round a box touches its rim between two nodes: its own chord lay on the rim."""
    ring = cq.Workplane().add(cq.Solid.makeTorus(2.376, 0.3861)).translate((0, 0, 6.265))
    model = sm.from_cadquery(cq.Workplane().box(3.96, 21.79, 12.53).union(ring))
    report = sm.check(sm.mesh(model, 1.1166776526689959))
    assert report.clean and report.euler == report.euler_exact == -2


def test_a_fine_bore_is_open_at_any_size():
    for bore, size in ((0.05, 0.9), (0.13, 1.8), (0.2, 3.0)):
        part = cq.Workplane().box(12, 15, 4).faces(">Z").workplane().hole(bore)
        report = sm.check(sm.mesh(sm.from_cadquery(part), size))
        assert report.clean and report.euler == 0, (bore, size, report.problems)
