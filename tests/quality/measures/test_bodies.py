"""Bodies that overlap are a problem; those that touch, and loose faces, are said with a cure."""

import cadquery as cq
import numpy as np
import pytest
from handmade_meshes import changed, icosphere
from hypothesis import given, settings
from hypothesis import strategies as st
from OCP.BRep import BRep_Builder
from OCP.BRepBuilderAPI import BRepBuilderAPI_Copy
from OCP.TopoDS import TopoDS_Compound

import surfmesh as sm
from surfmesh._core.space import triangle_distances
from surfmesh.quality.measures.inside import inside
from surfmesh.quality.measures.penetration import depths
from surfmesh.quality.measures.self_intersection import meeting_pairs
from surfmesh.result.surface_mesh import SurfaceMesh


def box(*size, at=(0, 0, 0)):
    return cq.Workplane().box(*size).translate(at).val()


def pin(radius, height=4.0, turn=0.0):
    made = cq.Workplane().circle(radius).extrude(height / 2, both=True)
    return made.rotate((0, 0, 0), (0, 0, 1), turn).val()


def plate():
    return cq.Workplane().box(10, 10, 2).faces(">Z").workplane().hole(3).val()


def ball(radius=2.0):
    return cq.Workplane().sphere(radius).rotate((0, 0, 0), (1, 2, 3), 40).val()


def socket():
    return cq.Workplane().box(6, 6, 6).cut(cq.Workplane().sphere(2)).val()


CHORD = sm.Sizing(chord=0.05)
STRETCHED = sm.Sizing(chord=0.02, anisotropy=8)
OVERLAPPING = {
    "one in another's corner": ([box(4, 4, 4), box(2, 2, 2, at=(1, 1, 1))], CHORD),
    "one within another": ([box(4, 4, 4), box(2, 2, 2, at=(0.1, 0.2, 0))], CHORD),
    "twice in one place": ([box(4, 4, 4), box(4, 4, 4)], CHORD),
    "equal balls, turned": ([ball(), cq.Workplane().sphere(2).val()], CHORD),
    "bars of one section": ([box(4, 1, 1), box(4, 1, 1, at=(2, 0, 0))], CHORD),
    "bars that cross": ([box(20, 1, 1), box(1, 20, 1, at=(0, 0, 0.3))], STRETCHED),
    "sunk in": ([box(4, 4, 4), box(2, 2, 2, at=(0, 0, 2.99))], CHORD),
    "press fit within the chord": ([plate(), pin(1.51)], CHORD),
    "press fit, stretched": ([plate(), pin(1.51)], STRETCHED),
    "press fit, coarse": ([plate(), pin(1.7)], sm.Sizing(size=1.0)),
}
TOUCHING = {
    "boxes": ([box(4, 4, 4), box(2, 2, 2, at=(0.3, 0.2, 3))], CHORD),
    "boxes a rounding apart": ([box(4, 4, 4), box(2, 2, 2, at=(0, 0, 3 + 1e-7))], CHORD),
    "bars that lie on each other": ([box(20, 1, 1), box(1, 20, 1, at=(0, 0, 1))], CHORD),
    "pin that sticks out": ([plate(), pin(1.5, turn=31)], CHORD),
    "pin, flush": ([plate(), pin(1.5, height=2.0)], sm.Sizing(size=1.0)),
    "pin, short and stretched": ([plate(), pin(1.5, height=1.0, turn=31)], STRETCHED),
    "ball in its socket": ([socket(), ball()], CHORD),
    "ball on a plate": ([box(10, 10, 1, at=(0, 0, -2.5)), cq.Workplane().sphere(2).val()], CHORD),
}
APART = {
    "pin with room": ([plate(), pin(1.3)], CHORD),
    "boxes": ([box(4, 4, 4), box(2, 2, 2, at=(0, 0, 3.01))], CHORD),
    "ball in a void": ([socket(), cq.Workplane().sphere(1).val()], CHORD),
}


@pytest.mark.parametrize("name", OVERLAPPING)
def test_bodies_that_overlap(name):
    parts, sizing = OVERLAPPING[name]
    report = sm.mesh(sm.from_cadquery(parts), sizing).report
    assert report.overlapping_bodies == 1 and report.touching_bodies == 0
    assert report.contacts == 0 and report.self_intersections == 0
    assert len(report.problems) == 1 and "1 pair of solids overlap: " in report.problems[0]
    assert report.bodies[0].kind == "overlap" and report.bodies[0].solids == (0, 1)


@pytest.mark.parametrize("name", TOUCHING)
def test_bodies_that_touch(name):
    parts, sizing = TOUCHING[name]
    report = sm.mesh(sm.from_cadquery(parts), sizing).report
    assert report.clean, report.problems
    assert report.touching_bodies == 1 and report.overlapping_bodies == 0
    assert any("touch without a common face" in said for said in report.warnings)
    assert any("imprint=True" in said and "--imprint" in said for said in report.warnings)


@pytest.mark.parametrize("name", APART)
def test_bodies_that_lie_apart(name):
    parts, sizing = APART[name]
    report = sm.mesh(sm.from_cadquery(parts), sizing).report
    assert report.clean and not report.warnings and not report.bodies


def test_facets_that_meet_where_faces_do_not():
    report = sm.mesh(sm.from_cadquery([plate(), pin(1.49)]), CHORD).report
    assert report.clean and report.touching_bodies == 0 and report.contacts > 0
    near = report.bodies[0]
    assert near.kind == "near" and near.gap == pytest.approx(0.01, rel=1e-6)
    assert any("smaller chord keeps them apart" in said for said in report.warnings)


@pytest.mark.parametrize("scale", [1e-3, 1e3])
def test_bodies_of_any_scale(scale):
    for parts, kinds in (([plate(), pin(1.5)], ["touch"]), ([plate(), pin(1.51)], ["overlap"])):
        parts = [part.scale(scale) for part in parts]
        report = sm.mesh(sm.from_cadquery(parts), sm.Sizing(chord=0.05 * scale)).report
        assert [pair.kind for pair in report.bodies] == kinds


@pytest.mark.parametrize("size", [0.7, 0.2])
@pytest.mark.parametrize("common", [0.1, 1.0, 1.5])
def test_depth_of_an_overlap_is_of_the_bodies_and_not_of_their_triangles(common, size):
    cubes = [box(2, 2, 2), box(2, 2, 2, at=3 * (2 - common,))]
    report = sm.mesh(sm.from_cadquery(cubes), size).report
    depth = min(common, 2 - common)  # of a corner, to the nearest face of the other
    assert report.bodies[0].depth == pytest.approx(depth, rel=1e-6)
    assert f"by at least {depth:.3g}, at" in report.problems[0]


def test_depth_of_balls_in_each_other():
    balls = [cq.Workplane().sphere(2).val().translate((x, 0, 0)) for x in (0, 2.5)]
    report = sm.mesh(sm.from_cadquery(balls), CHORD).report
    assert report.bodies[0].depth == pytest.approx(1.5, abs=0.1)


def test_names_of_an_assembly():
    both = cq.Assembly().add(cq.Workplane().box(4, 4, 4), name="one")
    both.add(cq.Workplane().box(4, 4, 4).translate((2.137, 1.091, 0.873)), name="two")
    report = sm.mesh(both, 1.0).report
    assert not report.clean and report.bodies[0].names == ("one", "two")
    assert report.bodies[0].depth > 0.1 and "bodies that meet" in report.to_text()


# ------------------------------------------------------------------ loose faces


def loose(shape):
    """The faces of a shape, none of which shares an edge with another."""
    build, made = BRep_Builder(), TopoDS_Compound()
    build.MakeCompound(made)
    for face in shape.Faces():
        build.Add(made, BRepBuilderAPI_Copy(face.wrapped).Shape())
    return cq.Shape.cast(made)


@pytest.mark.parametrize("shape", [box(3, 2, 1), pin(1.0), plate()], ids=["box", "pin", "plate"])
@pytest.mark.parametrize("sizing", [0.3, STRETCHED], ids=["size", "stretched"])
def test_faces_that_were_never_sewn(shape, sizing):
    report = sm.mesh(sm.from_cadquery(loose(shape)), sizing).report
    assert report.clean and not report.closed, report.problems
    faces = shape.Faces()
    assert report.loose_edges.faces == len(faces)
    seams = sum(face.geomType() == "CYLINDER" for face in faces)
    own = sum(len(face.Edges()) for face in faces)
    assert report.loose_edges.edges == own - seams
    assert any("sew=" in said and "--sew" in said for said in report.warnings)
    assert not any("imprint" in said for said in report.warnings)


@pytest.fixture(scope="module")
def tube_cut_along_its_seam(tmp_path_factory):
    """The faces of a tube as trimmed surfaces of IGES, which know no seam: the two rims of the
    outer and the inner face lie in one place."""
    from OCP.IGESControl import IGESControl_Writer

    path = tmp_path_factory.mktemp("iges") / "tube.igs"
    writer = IGESControl_Writer("MM", 0)
    writer.AddShape(cq.Workplane().circle(2).circle(0.35).extrude(4).val().wrapped)
    writer.ComputeModel()
    assert writer.Write(str(path))
    return path


def test_a_face_that_was_never_sewn_to_itself(tube_cut_along_its_seam):
    mesh = sm.mesh(sm.load(tube_cut_along_its_seam), CHORD)
    report = mesh.report
    assert report.clean and report.self_intersections == 0, report.problems
    assert report.loose_edges.edges == 12 and report.loose_edges.faces == 4
    sewn = sm.mesh(sm.load(tube_cut_along_its_seam, sew=1e-5), CHORD).report
    assert sewn.clean and sewn.closed and sewn.loose_edges is None


def test_a_face_that_crosses_itself_beside_its_seam(tube_cut_along_its_seam):
    mesh = sm.mesh(sm.load(tube_cut_along_its_seam), CHORD)
    radius = np.linalg.norm(mesh.points[:, :2], axis=1)
    seam = (np.abs(mesh.points[:, 1]) < 1e-6) & (mesh.points[:, 0] > 1.9) & (radius > 1.9)
    first = np.isin(
        np.arange(len(seam)),
        mesh.triangles[mesh.points[mesh.triangles][:, :, 1].max(axis=1) > 1e-3],
    )
    points = mesh.points.copy()
    points[seam & first, 1] -= 0.1  # past the other rim
    points[seam & first, 0] += 0.05 * np.where(points[seam & first, 2] > 2.0, 1.0, -1.0)
    report = sm.check(changed(mesh, points=points))
    assert report.self_intersections > 0 and not report.clean


def test_sheets_that_share_their_edges_are_not_loose():
    report = sm.mesh(sm.from_cadquery(box(3, 2, 1).Shells()[0]), 0.5).report
    assert report.loose_edges is None and report.clean and not report.warnings


def test_loose_faces_that_cross():
    across = cq.Face.makePlane(4, 4)
    through = cq.Face.makePlane(4, 4, (0.3, 0.2, 0.1), (0.2, 1, 0.3))
    report = sm.mesh(sm.from_cadquery([across, through]), 0.7).report
    assert report.self_intersections > 0 and report.contacts == 0
    assert "intersects itself" in report.problems[0]


def test_loose_faces_that_lie_on_each_other():
    parts = [cq.Face.makePlane(4, 4), cq.Face.makePlane(2, 2, (0.3, 0.2, 0), (0, 0, 1))]
    report = sm.mesh(sm.from_cadquery(parts), 0.7).report
    assert report.clean and report.contacts > 0 and report.touching_bodies == 1


# ------------------------------------------------------------------ the means


def test_points_within_a_ball():
    mesh = icosphere(3)
    points = np.random.default_rng(3).normal(size=(500, 3)) * 0.6
    size = np.linalg.norm(points, axis=1)
    told = (size < 0.98) | (size > 1.0)
    found = inside(points[told], mesh.points[mesh.triangles])
    assert np.array_equal(found, size[told] < 0.98)


def test_distance_from_triangles_against_samples():
    corners = np.array([[(0, 0, 0), (1, 0, 0), (0.2, 0.7, 0.3)]], float)
    weights = np.array([(i, j, 200 - i - j) for i in range(201) for j in range(201 - i)]) / 200
    samples = weights @ corners[0]
    for point in np.random.default_rng(4).uniform(-1, 2, (50, 3)):
        near = np.linalg.norm(samples - point, axis=1).min()
        assert triangle_distances(point[None], corners)[0] == pytest.approx(near, abs=0.01)


@settings(max_examples=60)
@given(depth=st.floats(1e-3, 0.5), slant=st.floats(-0.5, 0.5), power=st.integers(-3, 3))
def test_depth_of_a_wall_in_a_floor(depth, slant, power):
    floor = np.array([(-3, -3, 0), (3, -3, 0), (0, 4, 0)], float)
    wall = np.array([(-0.5, 0, -depth), (0.5, slant, -depth), (0, 0, 1)], float)
    scale = 10.0**power
    pair = np.stack([floor, wall])[None] * scale
    assert depths(pair)[0] == pytest.approx(depth * scale, rel=1e-9)
    assert depths(pair[:, ::-1])[0] == pytest.approx(depth * scale, rel=1e-9)
    assert (
        depths(pair + np.array([(0, 0, 0), (0, 0, depth)])[None, :, None] * scale)[0]
        < 1e-12 * scale
    )


def test_walls_that_meet_in_a_point_are_not_deep():
    below = np.array([(-1, 0.5, 0), (1, 0.5, 0), (0, 0.5, -1)], float)
    above = np.array([(0.1, -1, 0), (0.1, 2, 0), (0.1, 0, 1)], float)
    assert depths(np.stack([below, above])[None])[0] == 0.0


def test_solids_of_a_file_without_surfaces():
    """What solids of an .stl are is known by their names alone."""
    first, second = icosphere(2), icosphere(2)
    for shift, kind in ((0.5, "overlap"), (2.0, None)):
        points = np.concatenate([first.points, second.points + (shift, 0, 0)])
        count = len(first.triangles)
        mesh = SurfaceMesh(
            points=points,
            triangles=np.concatenate([first.triangles, second.triangles + len(first.points)]),
            solid_ids=np.array([(0, -1)] * count + [(1, -1)] * count),
        )
        assert [pair.kind for pair in mesh.report.bodies if pair.kind != "touch"] == [kind] * bool(
            kind
        )
    assert len(meeting_pairs(changed(first, surfaces=()))) == 0
