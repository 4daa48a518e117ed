"""``chord`` of quadratic triangles: kept by the curved ones, with far fewer of them."""

import cadquery as cq
import numpy as np
import pytest

import surfmesh as sm
from surfmesh.accuracy.curved_triangles import points_on
from surfmesh.errors import SizingError

_GRID = 13  # no multiple of what the mesher looks at
PLACES = np.array(
    [(i, j, _GRID - i - j) for i in range(_GRID + 1) for j in range(_GRID + 1 - i)]
) / float(_GRID)  # fmt: skip


def points_of(mesh):
    return points_on(mesh.nodes[mesh.elements], PLACES)


def off_torus(points):
    return abs(np.hypot(np.hypot(points[..., 0], points[..., 1]) - 3.0, points[..., 2]) - 1.0)


def off_sphere(points):
    return abs(np.linalg.norm(points, axis=-1) - 1.0)


@pytest.mark.parametrize(("name", "off", "chord"), [
    ("torus", off_torus, 1.1e-3), ("sphere", off_sphere, 3.4e-4),
])  # fmt: skip
def test_fifty_times_fewer_than_straight_triangles(name, off, chord):
    surface, sizes = sm.load(name), sm.Sizing(chord=chord, max_size=10.0)
    straight, curved = sm.mesh(surface, sizes), sm.mesh(surface, sizes, order=2)
    assert off(points_of(curved)).max() <= chord
    assert 50 * len(curved.triangles) < len(straight.triangles)
    report = curved.report
    assert report.clean, report.problems
    assert off(points_of(curved)).max() == pytest.approx(report.deviation_max, rel=0.05)
    assert report.deviation_two_sided <= chord
    assert report.jacobian_min > 0.3


def test_volumes_and_areas_are_those_of_curved_triangles():
    mesh = sm.mesh(sm.load("sphere"), chord=1e-4, max_size=10.0, order=2)
    report = mesh.report
    assert report.area == pytest.approx(4.0 * np.pi, rel=1e-4)
    assert report.volume == pytest.approx(4.0 / 3.0 * np.pi, rel=2e-4)


def test_order_may_stand_in_the_sizing():
    torus = sm.load("torus")
    one = sm.mesh(torus, sm.Sizing(chord=0.01, order=2))
    other = sm.mesh(torus, chord=0.01, order=2)
    np.testing.assert_array_equal(one.nodes, other.nodes)
    assert one.order == 2 and sm.mesh(torus, sm.Sizing(chord=0.1, order=2), order=1).order == 1
    with pytest.raises(SizingError, match="order is 3"):
        sm.Sizing(order=3)


@pytest.mark.parametrize("more", [{"volume": 0.05}, {"anisotropy": 4.0}])
def test_what_is_of_straight_triangles_is_sized_by_them(more):
    part = sm.from_cadquery(cq.Workplane().cylinder(2.0, 1.0))
    sizes = sm.Sizing(chord=0.05, **more)
    straight, curved = sm.mesh(part, sizes), sm.mesh(part, sizes, order=2)
    np.testing.assert_array_equal(straight.triangles, curved.triangles)


@pytest.fixture(scope="module")
def filleted():
    return sm.from_cadquery(cq.Workplane().box(4, 3, 2).edges("|Z").fillet(0.7).faces(">Z").hole(1))


def test_a_part_with_fillets_and_a_hole(filleted):
    chord = 2e-4
    sizes = sm.Sizing(chord=chord, max_size=1.0)
    mesh = sm.mesh(filleted, sizes, order=2)
    assert mesh.report.clean, mesh.report.problems
    assert mesh.report.deviation_two_sided <= chord
    assert 8 * len(mesh.triangles) < len(sm.mesh(filleted, sizes).triangles)
    round_ = [k for k, edge in enumerate(filleted.edges) if edge.curve.kind == "circle"]
    segments = np.isin(mesh.edge_ids, round_)
    nodes = mesh.nodes[mesh.edge_elements[segments]]
    t = np.linspace(0.0, 1.0, 17)
    weights = np.stack([(1 - t) * (1 - 2 * t), t * (2 * t - 1), 4 * t * (1 - t)])
    arcs = np.einsum("kt,nkd->ntd", weights, nodes)
    hole = np.hypot(*nodes[:, 0, :2].T) < 0.6
    assert hole.any() and not hole.all()
    assert abs(np.hypot(*arcs[hole][..., :2].transpose(2, 0, 1)) - 0.5).max() <= chord
    assert mesh.report.volume == pytest.approx(filleted.solids[0].volume, rel=1e-4)


def test_a_flat_disc_is_sized_by_its_rim():
    disc = sm.ParametricSurface("u*cos(v)", "u*sin(v)", "0", u=(0.3, 1), v=("0", "2*pi"))
    chord = 2e-5
    mesh = sm.mesh(disc, chord=chord, max_size=2.0, order=2)
    rim = mesh.connectivity.uses == 1
    ends, middle = mesh.points[mesh.edges[rim]], mesh.mid_points[rim]
    t = np.linspace(0.0, 1.0, 33)[:, None, None]
    arcs = (
        (1 - t) * (1 - 2 * t) * ends[:, 0] + t * (2 * t - 1) * ends[:, 1] + 4 * t * (1 - t) * middle
    )
    radius = np.hypot(arcs[..., 0], arcs[..., 1])
    off = np.minimum(abs(radius - 1.0), abs(radius - 0.3)).max()
    assert 0.2 * chord < off <= chord
    assert mesh.report.clean, mesh.report.problems


def test_planar_domains_have_polygons_for_outlines():
    square = sm.PlanarDomain(outer=[[(0, 0), (1, 0), (1, 1), (0, 1)]])
    assert sm.mesh(square, chord=0.1, order=2).order == 2
