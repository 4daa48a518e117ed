"""Sizes by selection, sources and gaps on CAD models; explain; estimate."""

import cadquery as cq
import numpy as np
import pytest

import surfmesh as sm
from surfmesh.errors import SizingError
from surfmesh.sizing.options.model_sizing import combined, model_sizing


def lengths(mesh):
    return np.linalg.norm(np.diff(mesh.points[mesh.edges], axis=1)[:, 0], axis=1)


def face_edge(mesh, face):
    """Mean edge length of the triangles of a face."""
    corners = mesh.points[mesh.triangles[mesh.face_ids == face]]
    return np.linalg.norm(corners - np.roll(corners, 1, axis=1), axis=2).mean()


@pytest.fixture(scope="module")
def block():
    part = cq.Workplane().box(10, 20, 30).edges("|Z").fillet(2)
    return sm.from_cadquery(part.faces(">Z").tag("lid").end())


def test_faces_edges_and_vertices_have_their_own_sizes(block):
    base = sm.mesh(block, 2.0)
    fine = sm.mesh(block, {"*": 2.0, "lid": 0.5, "edge:|Z and >X": 0.3, "vertex:0": 0.1})
    assert sm.check(fine).clean
    (lid,) = model_sizing(block, {"lid": 1.0}).faces
    assert face_edge(fine, lid) == pytest.approx(0.5, rel=0.15)
    assert fine.sizes[fine.vertex_ids[0]] == pytest.approx(0.1, rel=0.05)
    ratio = np.sort(fine.sizes[fine.edges], axis=1)
    assert np.quantile(ratio[:, 1] / ratio[:, 0], 0.99) < 1.35  # graded over faces and edges
    assert len(fine.triangles) > 2 * len(base.triangles)


def test_chord_of_some_faces(block):
    mesh = sm.mesh(block, {"*": 2.0, "type:cylinder": sm.Sizing(chord=0.005)})
    number = next(k for k, face in enumerate(block.faces) if face.kind == "cylinder")
    # h^2 / (8 R) is 62 % of the chord
    assert face_edge(mesh, number) == pytest.approx(np.sqrt(0.62 * 0.005 * 16.0), rel=0.1)


def test_min_size_of_a_selection_makes_it_coarser(block):
    fine = sm.mesh(block, sm.Sizing(chord=0.01))
    coarse = sm.mesh(block, {"*": sm.Sizing(chord=0.01), "type:cylinder": {"min_size": 1.0}})
    assert len(coarse.triangles) < len(fine.triangles) / 2


def test_everything_at_once_is_the_smallest():
    laws = [lambda p: np.full(len(p), 3.0), lambda p: np.full(len(p), 2.0)]
    found = combined([
        ("*", sm.Sizing(chord=1.0, max_size=9.0, growth=1.3)), ("a", sm.Sizing(chord=0.5)),
        ("b", sm.Sizing(size=laws[0], min_size=0.1)), ("c", sm.Sizing(size=laws[1])),
        ("d", sm.Sizing(size=5.0, gap=3)),
    ])  # fmt: skip
    assert (found.chord, found.max_size, found.min_size) == (0.5, 5.0, 0.1)
    assert (found.growth, found.gap) == (1.3, 3.0)
    assert found.size(np.zeros((4, 3))) == pytest.approx(2.0)


REFUSED = {
    "name": ({"lidd": 1.0}, "did you mean 'lid'"),
    "option": ({"chrod": 1.0}, "or did you mean the option 'chord'"),
    "mixed": ({"chord": 1.0, "lid": 2.0}, "options of the whole model .* under '\\*'"),
    "inner option": ({"lid": {"chrod": 1.0}}, "sizes of 'lid': unknown size option 'chrod'"),
    "growth": ({"lid": {"growth": 1.5}}, "growth holds for the whole model"),
    "nothing": ({"lid": {}}, "nothing is asked for"),
    "contradiction": (
        {"*": sm.Sizing(max_size=1.0), "lid": sm.Sizing(min_size=2.0)},
        "min_size 2 of 'lid' is above the largest size 1 that '\\*' allows",
    ),
}


@pytest.mark.parametrize("case", REFUSED)
def test_refused(block, case):
    sizes, message = REFUSED[case]
    for verb in (sm.mesh, sm.estimate):
        with pytest.raises(SizingError, match=message):
            verb(block, sizes)


def test_a_surface_is_one_face_by_its_name():
    sphere = sm.load("sphere")
    assert sm.estimate(sphere, {"*": 0.5}).triangles > 0
    coarse, fine = (sm.mesh(sphere, {"*": 0.5, "sph*": size}) for size in (0.9, 0.25))
    assert len(coarse.triangles) == len(sm.mesh(sphere, 0.5).triangles)  # the smallest holds
    assert len(fine.triangles) == len(sm.mesh(sphere, 0.25).triangles)
    for sizes, message in (
        ({"lid": sm.Sizing(size=1.0)}, "a surface is one face, which 'sphere', '\\*' or 'face:0'"),
        ({"*": 0.5, "type:plane": 0.1}, "sizes of 'type:plane': .* selected on CAD models"),
        ({"chrod": 0.1}, "unknown size option 'chrod'; did you mean 'chord'"),
        ({"hausd": 0.1}, "here it is called 'chord'"),
        ({"sphere": {"growth": 1.5}}, "growth holds for the whole model"),
    ):
        with pytest.raises(SizingError, match=message):
            sm.mesh(sphere, sizes)


def test_options_are_given_by_name():
    torus = sm.load("torus")
    for order in (1, 2):
        known = sm.estimate(torus, sm.Sizing(chord=0.1, order=order)).triangles
        assert sm.estimate(torus, chord=0.1, order=order).triangles == known
    for verb in (sm.mesh, sm.estimate):
        with pytest.raises(SizingError, match="given twice: as sizing, and as chord"):
            verb(torus, 0.1, chord=0.1)
    with pytest.raises(SizingError, match="'optimize'; did you mean 'optimise'"):
        sm.mesh(torus, optimize=False)


def test_small_sources_are_seen_in_the_middle_of_faces_and_edges():
    plate = sm.from_cadquery(cq.Workplane().box(1000, 1000, 5))
    inside, on_edge = [123.0, 77.0, 2.5], [500.0, 41.7, 2.5]
    sources = (sm.Near(inside, size=0.05), sm.InBall(on_edge, 0.5, 0.1))
    mesh = sm.mesh(plate, sm.Sizing(size=40.0, sources=sources))
    assert sm.check(mesh).clean
    for place, size in ((inside, 0.05), (on_edge, 0.1)):
        away = np.linalg.norm(mesh.points - place, axis=1)
        assert mesh.sizes[away.argmin()] < 1.5 * size
    assert len(mesh.triangles) < 60_000


@pytest.mark.parametrize("growth", [1.2, 1.6])
def test_triangles_across_thin_faces(growth):
    plate = sm.from_cadquery(cq.Workplane().box(100, 100, 2))
    mesh = sm.mesh(plate, sm.Sizing(size=20.0, gap=3, growth=growth))
    side = next(k for k, f in enumerate(plate.faces) if f.area < 300.0)
    points = mesh.points[mesh.triangles[mesh.face_ids == side]]
    axis = int(np.argmin(np.ptp(points.reshape(-1, 3), axis=0) + 1e9 * (np.arange(3) == 2)))
    along = 1 - axis
    low, high = points[..., along].min(axis=1), points[..., along].max(axis=1)
    for x in np.linspace(-45.0, 45.0, 50) + 0.01:  # triangles that a line across meets
        assert ((low < x) & (x < high)).sum() >= 3


def test_explain_names_the_rule(block):
    sizes = {"*": 2.0, "lid": sm.Sizing(size=0.4)}
    found = sm.explain(block, sizes, (0, 0, 15))
    assert found.winner.key == "lid" and found.size == pytest.approx(0.4)
    assert not found.origin and [row.size for row in found.rows] == [0.4, 2.0]
    below = sm.explain(block, sizes, (5, 0, 14))
    assert below.winner.key == "lid" and below.origin.startswith("edge")
    assert 0.4 < below.size < below.target_size == 2.0
    assert "grown from edge" in str(below)
    far = sm.explain(block, sizes, (5, 0, -10))
    assert far.winner.key == "*" and far.size == pytest.approx(2.0)
    with pytest.raises(SizingError, match="a point is three finite numbers"):
        sm.explain(block, sizes, (1, 2))


def test_explain_on_a_formula_surface():
    sizing = sm.Sizing(size=0.5, sources=sm.Near([0, 0, 1], size=0.05))
    found = sm.explain(sm.load("sphere"), sizing, (0.0, 0.1, 1.0))
    assert found.rows[0].rule.startswith("source Near") and found.winner == found.rows[0]
    assert found.size == pytest.approx(found.target_size, rel=0.1)
    assert found.to_dict()["winner"]["key"] == "*"


PARTS = {
    "plate": cq.Workplane().box(60, 40, 5).faces(">Z").workplane().rarray(15, 12, 3, 3).hole(6),
    "cylinder": cq.Workplane().cylinder(20, 5),
    "torus": cq.Workplane().add(cq.Solid.makeTorus(10, 3)),
    "fillets": cq.Workplane().box(10, 20, 30).edges().fillet(2),
    "shell": cq.Workplane().box(10, 20, 30).faces(">Z").shell(-1),
}


@pytest.mark.parametrize("name", PARTS)
def test_estimate_of_parts(name):
    model = sm.from_cadquery(PARTS[name])
    source = sm.InBall(model.vertices[0].point, 1.0, 0.2)
    for sizing in (None, model.diagonal / 30, sm.Sizing(size=3.0, sources=source)):
        found, mesh = sm.estimate(model, sizing), sm.mesh(model, sizing)
        assert found.triangles == pytest.approx(len(mesh.triangles), rel=0.15)
        assert sum(found.by_face) == pytest.approx(found.triangles, abs=len(model.faces))


@pytest.mark.parametrize(
    "name", ["two_peaks", "sphere", "torus", "klein", "pierced_saddle", "letter_a", "floor_plate"]
)
def test_estimate_of_the_gallery(name):
    surface = sm.load(name)
    found = sm.estimate(surface)
    assert found.triangles == pytest.approx(len(sm.mesh(surface).triangles), rel=0.08)


def test_the_limit_is_kept_before_anything_is_made(block):
    for thing in (block, sm.load("sphere"), sm.load("letter_a")):
        with pytest.raises(SizingError, match=r"about .* triangles .* limit of 1,000; .* memory"):
            sm.mesh(thing, sm.Sizing(size=0.05, limit=1000))
    with pytest.raises(SizingError, match="on face"):
        sm.mesh(block, {"*": 2.0, "lid": 1e-4})
    with pytest.raises(SizingError, match="limit"):
        sm.mesh(block, 1e-9)


def test_gaps_of_planar_domains():
    strip = sm.PlanarDomain([[0, 0], [100, 0], [100, 2], [0, 2]])
    mesh = sm.mesh(strip, sm.Sizing(size=20.0, gap=3))
    along = mesh.points[mesh.triangles][..., 0]
    low, high = along.min(axis=1), along.max(axis=1)
    for x in np.linspace(5.0, 95.0, 50) + 0.01:
        assert ((low < x) & (x < high)).sum() >= 3


def test_near_faces_of_a_solid():
    wall = sm.from_cadquery(cq.Workplane().circle(20).circle(19).extrude(10))
    sizing = sm.Sizing(size=5.0, gap=2, gap_faces=True)
    mesh = sm.mesh(wall, sizing)
    assert sm.check(mesh).clean
    for number, face in enumerate(wall.faces):
        if face.kind == "cylinder":
            assert face_edge(mesh, number) == pytest.approx(0.5, rel=0.1)
    found = sm.explain(wall, sizing, (20, 0, 5))
    assert found.winner.key == "gap_faces" and "gap to face" in found.winner.rule
    assert sm.estimate(wall, sizing).triangles == pytest.approx(len(mesh.triangles), rel=0.1)


@pytest.mark.parametrize(
    "sizing",
    [
        {"*": sm.Sizing(anisotropy=20), ">Z": 0.5},
        {"*": sm.Sizing(size=3.0, anisotropy=20), "type:cylinder": sm.Sizing(chord=0.02)},
        sm.Sizing(anisotropy=20, chord=0.02, sources=[sm.Near([0, 5, 30], size=0.2)]),
    ],
    ids=["finer end", "stretched by name", "source"],
)
def test_names_and_sources_where_sizes_have_a_direction(sizing):
    tube = sm.from_cadquery(cq.Workplane().circle(5).circle(4).extrude(60))
    mesh = sm.mesh(tube, sizing)
    report = sm.check(mesh)
    assert report.clean
    assert report.quasi_unit_share > 0.95  # in the metric; round where a face has no direction
    assert mesh.metric_root_3d.shape == (len(mesh.uv_points), 6)
    assert sm.estimate(tube, sizing).triangles == pytest.approx(len(mesh.triangles), rel=0.2)


def test_a_size_by_name_does_not_let_edges_beside_it_be_much_coarser_than_their_metric():
    tube = sm.from_cadquery(cq.Workplane().circle(5).circle(4).extrude(60))
    free = sm.mesh(tube, sm.Sizing(anisotropy=20))
    fine = sm.mesh(tube, {"*": sm.Sizing(anisotropy=20), "edge:|Z": 1.0})
    seam = next(k for k, edge in enumerate(tube.edges) if edge.start != edge.end)
    count = [int((mesh.edge_ids == seam).sum()) for mesh in (free, fine)]
    assert count[1] >= 58 > 10 * count[0]


def test_triangles_across_thin_faces_whatever_the_anisotropy():
    ring = sm.from_cadquery(cq.Workplane().circle(10).circle(8).extrude(1))
    number = next(k for k, face in enumerate(ring.faces) if face.kind == "cylinder")
    mesh = sm.mesh(ring, sm.Sizing(chord=0.05, anisotropy=20, gap=3))
    corners = mesh.points[mesh.triangles[mesh.face_ids == number]]
    angle = np.arctan2(corners[..., 1], corners[..., 0])
    near = np.abs(angle).max(axis=1) < 3.0  # away from where the angle jumps
    low, high = angle[near].min(axis=1), angle[near].max(axis=1)
    for x in np.linspace(-2.5, 2.5, 50):
        assert ((low < x) & (x < high)).sum() >= 3
