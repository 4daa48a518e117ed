"""The boundary of a face in rows, and a face in one call of the core."""

import pickle

import numpy as np
import pytest

from surfmesh._core import faces as core
from surfmesh._core.faces import BoundaryBuilder, FaceBoundary, FaceEnd, FacePolygons
from surfmesh._core.surfaces import cylinder, plane
from surfmesh.geometry.cad_surfaces.elementary import Plane
from surfmesh.sizing.field.boundary_field import boundary_field
from surfmesh.sizing.options.sizing import Sizing
from surfmesh.sizing.rules.size_rules import asked_rules

O, X, Y, Z = np.zeros(3), *np.eye(3)
SURFACE = plane(((0.0, 1.0), (0.0, 1.0)), O, X, Y)
TURN = 2.0 * np.pi
CORNERS = np.array([[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]])
PLAIN = core.FaceManner(None, None, 0.0)


def square(size=0.25, parts=4):
    """A unit square, each side in so many parts."""
    builder = BoundaryBuilder()
    for k, (start, end) in enumerate(zip(CORNERS, np.roll(CORNERS, -1, axis=0))):
        t = np.linspace(0.0, 1.0, parts + 1)
        uv = start + t[:, None] * (end - start)
        numbers = (k * parts + np.arange(parts + 1)) % (4 * parts)
        points = np.column_stack([uv, np.zeros(len(uv))])
        builder.add(uv, numbers, points, np.full(len(uv), size), False, 1e-6)
    builder.end_loop()
    return builder.boundary()


def tube(radius, height, count=9):
    """A whole cylinder: round, up its seam, back round, down its seam."""
    builder = BoundaryBuilder()
    t = np.linspace(0.0, 1.0, count)
    corners = np.array([[0.0, 0.0], [TURN, 0.0], [TURN, height], [0.0, height]])
    ring, seam = np.arange(count - 1), 100 + np.arange(count)
    rows = [np.append(ring, 0), seam, np.append(50 + ring, 50)[::-1], seam[::-1]]
    for start, end, numbers in zip(corners, np.roll(corners, -1, axis=0), rows):
        uv = start + t[:, None] * (end - start)
        points = np.column_stack([radius * np.cos(uv[:, 0]), radius * np.sin(uv[:, 0]), uv[:, 1]])
        builder.add(uv, numbers, points, np.ones(count), False, 0.0)
    builder.end_loop()
    domain = (0.0, TURN), (0.0, height)
    return cylinder(domain, O, X, Y, Z, radius), builder.boundary()


def test_it_travels_between_processes():
    one = square()
    other = pickle.loads(pickle.dumps(one))
    for name in ("uv", "numbers", "points", "sizes", "piece_end", "loop_end", "tolerance"):
        assert np.array_equal(getattr(one, name), getattr(other, name))


def test_what_is_no_boundary_is_refused():
    rows = np.zeros((4, 2)), np.arange(4), np.zeros((4, 3)), np.ones(4)
    flags = np.zeros(2, np.uint8), np.zeros(2)
    with pytest.raises(ValueError, match="piece_end"):
        FaceBoundary(*rows, np.array([1, 4], np.int32), *flags, np.array([2], np.int32))
    with pytest.raises(ValueError, match="loop_end"):
        FaceBoundary(*rows, np.array([2, 4], np.int32), *flags, np.array([1], np.int32))
    with pytest.raises(ValueError, match="length"):
        FaceBoundary(*rows, np.array([4], np.int32), *flags, np.array([1], np.int32))
    with pytest.raises(ValueError, match="two nodes"):
        BoundaryBuilder().add(
            np.zeros((1, 2)), np.zeros(1, int), np.zeros((1, 3)), np.ones(1), False, 0.0
        )


def inward(boundary, largest):
    asked = asked_rules(Sizing(size=largest))
    return core.mesh_inward(core.inward_face(SURFACE, boundary, None, asked, 0.2, PLAIN))


def test_a_square_is_meshed_between_its_nodes():
    boundary = square()
    made = inward(boundary, 1.0)
    assert made.end == FaceEnd.DONE and not len(made.coarse.sizes)
    mapped, slots = made.patch.mapped, made.slots
    known = slots >= 0
    assert np.count_nonzero(known) == 16 and known.sum() < len(mapped.points)
    assert np.array_equal(mapped.points[known], boundary.points[slots[known]])
    corners = mapped.points[mapped.triangles]
    normals = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    assert 0.5 * normals[:, 2].sum() == pytest.approx(1.0) and (normals[:, 2] > 0.0).all()


def test_segments_far_longer_than_the_sizes_inside_are_named():
    made = inward(square(0.5, 1), 0.1)
    middles = 0.5 * (CORNERS + np.roll(CORNERS, -1, axis=0))
    assert np.allclose(made.coarse.points[:, :2], middles) and (made.coarse.sizes <= 0.1).all()


def test_sizes_that_are_none_are_a_status():
    assert inward(square(-1.0), 1.0).end == FaceEnd.UNPREPARED


def test_a_loop_that_runs_twice_is_a_status():
    uv, points = np.tile(CORNERS, (2, 1)), np.zeros((8, 3))
    polygons = FacePolygons(uv, np.tile(np.arange(4), 2), points, np.arange(8), np.array([8], "i4"))
    surface = Plane(domain=((0.0, 1.0), (0.0, 1.0)), origin=O, x=X, y=Y, z=Z)
    sizes = boundary_field(surface, Sizing(size=0.5), CORNERS, np.full(4, 0.5))
    chart = sizes.chart.core
    made = core.mesh_face(surface.core, chart, sizes.background, polygons, PLAIN)
    assert made.end == FaceEnd.RUNS_TWICE


@pytest.mark.parametrize("radius, thin", [(0.05, True), (0.1, False), (1.0, False)])
def test_a_seam_near_to_itself_may_be_a_tube(radius, thin):
    """The seam has steps of 1/8: less than 2.5 of them go round a radius of 0.0497."""
    assert core.may_have_tubes(*tube(radius * 0.99, 1.0)) == thin
    assert not core.may_have_tubes(SURFACE, square())
