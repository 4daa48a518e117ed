"""Order 2: nodes amid edges lie on the true curve or surface, and no triangle folds."""

import dataclasses

import cadquery as cq
import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

import surfmesh as sm
from surfmesh.errors import SizingError
from surfmesh.meshing.finishing.second_order import LEAST_JACOBIAN, of_second_order
from surfmesh.result.quadratic_triangles import least_jacobians, six_nodes
from surfmesh.result.surface_mesh import SurfaceMesh

STRAIGHT = np.array([(0, 0, 0), (1, 0, 0), (0, 1, 0), (0.5, 0, 0), (0.5, 0.5, 0), (0, 0.5, 0)])
INSIDE = np.array([-1, -1, -1, 4, 4, 4]) / 9  # values of the six functions in the centre


def jacobians(mesh):
    return least_jacobians(mesh.nodes, mesh.elements)


def test_the_error_falls_with_the_fourth_power():
    """Quadratic interpolation on a sphere, whose symmetry lends one order."""
    errors, lengths = [], []
    for size in (0.4, 0.2, 0.1):
        mesh = sm.mesh(sm.load("sphere"), size, order=2)
        assert mesh.order == 2 and not mesh.warnings
        radius = np.linalg.norm(mesh.nodes, axis=1)
        np.testing.assert_allclose(radius, radius[0], rtol=1e-12)
        centres = INSIDE @ mesh.nodes[mesh.elements]
        errors.append(np.sqrt(np.mean((np.linalg.norm(centres, axis=1) - radius[0]) ** 2)))
        lengths.append(len(mesh.triangles) ** -0.5)
        assert jacobians(mesh).min() > 0.9
    rates = np.diff(np.log(errors)) / np.diff(np.log(lengths))
    assert rates.min() > 3.5


def test_a_seam_has_one_node_for_both_its_images():
    mesh = sm.mesh(sm.load("torus"), 0.2, order=2)
    assert len(mesh.mid_points) == len(mesh.edges)
    assert len(np.unique(mesh.nodes.round(9), axis=0)) == len(mesh.nodes)
    assert jacobians(mesh).min() > 0.8


@pytest.fixture(scope="module")
def plate():
    """10 x 10 x 2 with a hole of radius 2: circles that bound plane faces and a cylinder."""
    return sm.from_cadquery(cq.Workplane().box(10, 10, 2).faces(">Z").workplane().hole(4))


@pytest.mark.parametrize("size", [0.5, 3.0])
def test_nodes_of_cad_edges_lie_on_their_curves(plate, size):
    mesh = sm.mesh(plate, size, order=2)
    around = [number for number, edge in enumerate(plate.edges) if edge.curve.kind == "circle"]
    segments = mesh.edge_segments[np.isin(mesh.edge_ids, around)]
    rows = {tuple(edge): row for row, edge in enumerate(mesh.edges.tolist())}
    middles = mesh.mid_points[[rows[tuple(sorted(pair))] for pair in segments.tolist()]]
    assert len(around) == 2 and len(middles) >= 6
    np.testing.assert_allclose(np.hypot(*middles[:, :2].T), 2.0, rtol=1e-12)
    ends = mesh.points[segments]
    sides = np.linalg.norm(middles[:, None] - ends, axis=2)
    np.testing.assert_allclose(sides[:, 0], sides[:, 1], rtol=1e-6)
    on_cylinder = np.isin(mesh.face_ids, [f for f, s in enumerate(mesh.surfaces)
                                          if s.kind == "cylinder"])  # fmt: skip
    nodes = mesh.nodes[mesh.elements[on_cylinder]].reshape(-1, 3)
    np.testing.assert_allclose(np.hypot(*nodes[:, :2].T), 2.0, rtol=1e-9)
    assert jacobians(mesh).min() > LEAST_JACOBIAN / 2 and not mesh.warnings


def test_a_curved_boundary_is_met_by_nodes_of_a_formula(tmp_path):
    """The rim of a paraboloid is a circle, a side of the rectangle that bounds it."""
    bowl = sm.ParametricSurface("u*cos(v)", "u*sin(v)", "u**2", u=(0.2, 1), v=("0", "2*pi"))
    mesh = sm.mesh(bowl, 0.3, order=2)
    on_rim = mesh.connectivity.uses == 1
    radii = np.hypot(*mesh.mid_points[on_rim, :2].T)
    assert np.minimum(abs(radii - 1), abs(radii - 0.2)).max() < 1e-12
    np.testing.assert_allclose(mesh.mid_points[:, 2], (mesh.mid_points[:, :2] ** 2).sum(axis=1))


class Ripple:
    """(u, v, sin(9 u) / 2): far too wild for the triangles below."""

    name, domain, loops = "ripple", ((0.0, 1.0), (0.0, 1.0)), ()

    def evaluate(self, uv, order=0):
        (u, v), one, zero = uv.T, np.ones(len(uv)), np.zeros(len(uv))
        values = [(u, v, np.sin(9 * u) / 2)]
        if order > 0:
            values += [(one, zero, 4.5 * np.cos(9 * u)), (zero, one, zero)]
        return tuple(np.stack(value, axis=-1) for value in values)


def test_triangles_that_would_fold_are_straightened_and_it_is_said():
    uv = np.array([(x, y) for x in np.linspace(0, 1, 4) for y in np.linspace(0, 1, 4)])
    corners = [4 * i + j for i in range(3) for j in range(3)]
    triangles = [(k, k + 4, k + 5) for k in corners] + [(k, k + 5, k + 1) for k in corners]
    points = Ripple().evaluate(uv)[0]
    mesh = SurfaceMesh(points=points, triangles=triangles, uv_points=uv, surfaces=(Ripple(),))
    made = of_second_order(mesh)
    assert jacobians(made).min() >= LEAST_JACOBIAN
    assert len(made.warnings) == 1 and "are straight, lest triangles fold" in made.warnings[0]
    chords = mesh.points[mesh.edges].mean(axis=1)
    assert 0 < (np.linalg.norm(made.mid_points - chords, axis=1) == 0).sum() < len(chords)


def test_a_mesh_without_surfaces_has_its_nodes_on_chords(plate):
    nothing = {"surfaces": (), "turned_faces": None, "narrow_faces": None, "edge_curves": ()}
    mesh = dataclasses.replace(sm.mesh(plate, 3.0), **nothing)
    made = of_second_order(mesh)
    np.testing.assert_array_equal(made.mid_points, mesh.points[mesh.edges].mean(axis=1))
    np.testing.assert_allclose(jacobians(made), 1.0)


def test_solids_that_share_a_face_are_checked_in_order_2_too():
    from OCP.BOPAlgo import BOPAlgo_Builder

    fuse = BOPAlgo_Builder()
    fuse.AddArgument(cq.Solid.makeBox(2, 2, 1).wrapped)
    fuse.AddArgument(cq.Solid.makeCylinder(0.5, 1, cq.Vector(1, 1, 1)).wrapped)
    fuse.Perform()
    mesh = sm.mesh(sm.from_cadquery(cq.Shape.cast(fuse.Shape())), 0.5, order=2)
    assert (mesh.solid_ids >= 0).all(axis=1).any()
    report = sm.check(mesh)
    assert report.clean, report.problems


def test_other_orders_are_refused():
    with pytest.raises(SizingError, match="order is 3: meshes are of order 1 or 2"):
        sm.mesh(sm.load("plane"), order=3)


def test_the_jacobian_of_a_straight_triangle_is_one_wherever_it_lies():
    turn = np.linalg.qr(np.random.default_rng(5).normal(size=(3, 3)))[0]
    for scale in (1e-9, 1.0, 1e9):
        nodes = STRAIGHT @ turn * scale + scale
        np.testing.assert_allclose(least_jacobians(nodes, np.arange(6)[None]), 1.0, rtol=1e-9)


@given(st.lists(st.floats(-0.4, 0.4), min_size=6, max_size=6))
def test_no_jacobian_lies_below_the_bound(moves):
    nodes = STRAIGHT.astype(float)
    nodes[3:, :2] += np.reshape(moves, (3, 2))
    bound = least_jacobians(nodes, np.arange(6)[None])[0]
    fraction = np.linspace(0, 1, 12)
    s, t = (x[np.add.outer(fraction, fraction) <= 1] for x in np.meshgrid(fraction, fraction))
    r = 1 - s - t
    zero = np.zeros_like(s)
    along_s = np.array([1 - 4 * r, 4 * s - 1, zero, 4 * (r - s), 4 * t, -4 * t]).T @ nodes
    along_t = np.array([1 - 4 * r, zero, 4 * t - 1, -4 * s, 4 * s, 4 * (r - t)]).T @ nodes
    assert bound <= np.cross(along_s, along_t)[:, 2].min() + 1e-12


def test_six_nodes_share_the_middle_of_a_common_edge():
    triangles = np.array([(0, 1, 2), (2, 1, 3)], np.int32)
    mesh = SurfaceMesh(points=np.zeros((4, 3)), triangles=triangles)
    found = six_nodes(triangles, mesh.connectivity, 4)
    assert found[0, 4] == found[1, 3] and len(np.unique(found[:, 3:])) == 5
