"""The report on meshes whose every figure is known."""

import json

import numpy as np
import pytest
from handmade_meshes import Saddle, changed, grid, icosphere
from hypothesis import given, settings
from hypothesis import strategies as st

from surfmesh._core.space import component_labels
from surfmesh.quality import check
from surfmesh.quality.measures.shape import shapes
from surfmesh.quality.measures.topology import topology
from surfmesh.result.surface_mesh import SurfaceMesh
from surfmesh.sizing.options.sizing import Sizing


def test_regular_tetrahedron(tetrahedron):
    mesh = changed(tetrahedron, sizes=np.full(4, 8**0.5))
    report = check(mesh)
    assert report.clean, report.problems
    assert (report.euler, report.closed, report.manifold, report.oriented) == (2, True, True, True)
    assert (report.components, report.boundary_loops) == (1, 0)
    for value in (report.alpha_mean, report.alpha_min, report.radius_ratio_min, report.length_mean):
        assert value == pytest.approx(1, abs=1e-12)
    assert report.min_angle_deg == pytest.approx(60) == report.max_angle_deg
    assert report.area == pytest.approx(8 * 3**0.5)  # side sqrt 8: sqrt 3 a^2
    assert report.volume == pytest.approx(8 / 3)  # a^3 / (6 sqrt 2)
    assert report.quasi_unit_share == 1 and report.growth_max == pytest.approx(1)
    assert report.deviation_max is None and "carries no surface" in str(report)


def slow_shape(a, b, c):
    sides = np.sort([np.linalg.norm(b - a), np.linalg.norm(c - b), np.linalg.norm(a - c)])
    area = np.linalg.norm(np.cross(b - a, c - a)) / 2
    angles = []
    for p, q, r in ((a, b, c), (b, c, a), (c, a, b)):
        cosine = (q - p) @ (r - p) / np.linalg.norm(q - p) / np.linalg.norm(r - p)
        angles.append(np.degrees(np.arccos(np.clip(cosine, -1, 1))))
    inner, outer = 2 * area / sides.sum(), sides.prod() / (4 * area)
    alpha = 4 * 3**0.5 * area / (sides**2).sum()
    return area, alpha, 2 * inner / outer, min(angles), max(angles)


def test_shapes_agree_with_their_slow_twin():
    points = np.random.default_rng(1).normal(size=(60, 3))
    mesh = SurfaceMesh(points=points, triangles=np.arange(60).reshape(-1, 3))
    expected = [slow_shape(*points[corners]) for corners in mesh.triangles]
    np.testing.assert_allclose(np.column_stack(shapes(mesh)), expected, rtol=1e-6)


@settings(max_examples=50, deadline=None)
@given(st.floats(-9, 9), st.integers(0, 2**31))
def test_shapes_do_not_depend_on_scale_or_place(power, seed):
    rng = np.random.default_rng(seed)
    points, triangles = rng.normal(size=(3, 3)), [(0, 1, 2)]
    turn, _ = np.linalg.qr(rng.normal(size=(3, 3)))
    moved = 10.0**power * (points @ turn)
    here = shapes(SurfaceMesh(points=points, triangles=triangles))
    there = shapes(SurfaceMesh(points=moved, triangles=triangles))
    np.testing.assert_allclose(np.array(there[1:]), np.array(here[1:]), rtol=1e-6)
    np.testing.assert_allclose(there.area, here.area * 100.0**power, rtol=1e-6)


@settings(max_examples=50, deadline=None)
@given(st.integers(1, 20), st.lists(st.tuples(st.integers(0, 19), st.integers(0, 19))))
def test_components_agree_with_their_slow_twin(count, pairs):
    pairs = [(a % count, b % count) for a, b in pairs]
    labels = component_labels(count, np.array(pairs, np.int32).reshape(-1, 2))
    slow = list(range(count))
    for _ in range(count):
        for a, b in pairs:
            slow[a] = slow[b] = min(slow[a], slow[b])
    assert labels.tolist() == slow


def test_icosphere_deviation_is_the_depth_of_its_flattest_triangle():
    mesh = icosphere(3)
    report = check(mesh)
    depth = 1 - np.linalg.norm(mesh.points[mesh.triangles].mean(axis=1), axis=1)
    deepest = 0.0  # the foot of the perpendicular from the sphere's centre
    for a, b, c in mesh.points[mesh.triangles]:
        normal = np.cross(b - a, c - a)
        deepest = max(deepest, 1 - abs(a @ normal) / np.linalg.norm(normal))
    assert report.clean, report.problems
    assert report.euler == 2 and report.volume == pytest.approx(4 / 3 * np.pi, rel=0.02)
    assert depth.max() * (1 - 1e-9) <= report.deviation_max <= deepest * (1 + 1e-6)
    assert report.deviation_max == pytest.approx(deepest, rel=1e-3)
    assert np.linalg.norm(report.deviation_point) == pytest.approx(1 - report.deviation_max)


def test_deviation_falls_with_the_square_of_the_edge():
    first, second = check(icosphere(2)), check(icosphere(3))
    rate = np.log2(first.deviation_max / second.deviation_max)
    assert rate == pytest.approx(2, abs=0.1)
    assert np.log2(first.deviation_rms / second.deviation_rms) == pytest.approx(2, abs=0.1)


def test_deviation_is_measured_to_the_surface_not_to_the_image_of_uv():
    """A flat surface with a skewed parametrisation: interpolated (u, v) are far off."""

    class Skewed(Saddle):
        def evaluate(self, uv, order=0):
            u, v = uv.T
            one, zero = np.ones(len(uv)), np.zeros(len(uv))
            values = [(u + 0.4 * u * u, v, zero), (one + 0.8 * u, zero, zero), (zero, one, zero)]
            values += [(0.8 * one, zero, zero), (zero, zero, zero), (zero, zero, zero)]
            return tuple(np.stack(value, axis=-1) for value in values[: (1, 3, 6)[order]])

    report = check(grid(Skewed(), 3))
    assert report.deviation_max < 1e-12
    assert report.clean


def test_rms_of_a_known_offset():
    mesh = grid(Saddle(), 40)
    flat = changed(mesh, points=mesh.points * (1, 1, 0))
    u, v = np.meshgrid(*[(np.arange(400) + 0.5) / 200 - 1] * 2)
    away = np.abs(u * u - v * v)  # never farther than straight up
    report = check(flat)
    assert 0 < report.deviation_rms < np.sqrt((away**2).mean())
    assert report.deviation_max < away.max() + 1e-9


def test_vertices_off_the_surface_are_seen():
    mesh = grid(Saddle(), 20)
    points = mesh.points.copy()
    points[220] += (0, 0, 0.01)  # the middle, where the surface is level
    report = check(changed(mesh, points=points))
    assert report.deviation_max == pytest.approx(0.01, rel=1e-3)
    assert 220 in mesh.triangles[report.deviation_triangle]


def test_chord_that_was_asked_for():
    mesh = icosphere(2)
    reached = check(mesh).deviation_max
    kept = check(changed(mesh, sizing=Sizing(chord=reached)))
    missed = check(changed(mesh, sizing=Sizing(chord=reached * 0.999)))
    assert kept.clean and kept.above_chord_share == 0
    assert not missed.clean and missed.above_chord_share > 0
    assert "was asked for" in missed.problems[0]


def test_inverted_triangle():
    mesh = grid(Saddle(), 6)
    triangles, uv = mesh.triangles.copy(), mesh.uv_triangles.copy()
    triangles[10], uv[10] = triangles[10, [1, 0, 2]], uv[10, [1, 0, 2]]
    report = check(changed(mesh, triangles=triangles, uv_triangles=uv))
    assert (report.inverted, report.folded, report.oriented) == (1, 1, False)
    assert any("1 triangle inverted" in said and "first 10 at" in said for said in report.problems)
    assert any("opposite orientation" in said for said in report.problems)


def test_hole(tetrahedron):
    report = check(
        changed(tetrahedron, triangles=tetrahedron.triangles[1:], uv_triangles=None, face_ids=None)
    )
    assert report.clean and not report.closed
    assert (report.euler, report.boundary_loops, report.volume) == (1, 1, None)


def test_edge_of_three_triangles():
    points = [(0, 0, 0), (1, 0, 0), (0, 1, 0), (0, -1, 0), (0, 0, 1)]
    report = check(SurfaceMesh(points=points, triangles=[(0, 1, 2), (1, 0, 3), (0, 1, 4)]))
    assert not report.manifold and not report.clean
    assert report.problems[0].startswith("1 edge shared by more than two triangles, first 0-1")


def test_two_fans_that_touch_in_a_vertex():
    points = [(0, 0, 0), (1, 0, 0), (0, 1, 0), (-1, 0, 0), (0, -1, 0)]
    mesh = SurfaceMesh(points=points, triangles=[(0, 1, 2), (0, 3, 4)])
    assert topology(mesh).pinched_vertices.tolist() == [0]
    assert not check(mesh).manifold


def test_moebius_band_is_no_fault_when_it_is_meant(moebius_band):
    report = check(moebius_band)
    assert (report.euler, report.boundary_loops, report.manifold) == (0, 1, True)
    assert not report.oriented and not report.clean
    meant = check(changed(moebius_band, one_sided=True))
    assert meant.clean and "one-sided" in str(meant)


def test_triangle_without_area():
    points = [(0, 0, 0), (1, 0, 0), (2, 0, 0), (1, 1, 0)]
    report = check(SurfaceMesh(points=points, triangles=[(0, 1, 2), (0, 2, 3)]))
    assert report.degenerate == 1 and report.alpha_min == 0
    assert report.problems == ("1 triangle without area, first 0 at (1, 0, 0)",)


def test_angles_of_a_needle():
    """By the law of cosines the smallest was 0, and the largest degrees off."""
    points = np.array([(0, 0, 0), (1e-9, 3e-9, 1e-9), (0.3, 0.7, 1.1)])
    report = check(SurfaceMesh(points=points, triangles=[(0, 1, 2)]))
    short, long = points[1], points[2]
    there = long - short  # exact to a digit of the long side, which is what counts for the angle
    sine = np.linalg.norm(np.cross(long, short)) / np.linalg.norm(long) / np.linalg.norm(there)
    assert report.min_angle_deg == pytest.approx(np.degrees(np.arcsin(sine)), rel=1e-9)
    obtuse = np.arctan2(np.linalg.norm(np.cross(short, there)), -short @ there)
    assert report.max_angle_deg == pytest.approx(np.degrees(obtuse), rel=1e-9)


def test_pillow_of_two_equal_triangles():
    report = check(SurfaceMesh(points=np.eye(3), triangles=[(0, 1, 2), (0, 2, 1)]))
    assert report.problems == ("triangles 0 and 1 have the same corners",)


def test_points_that_are_not_finite_and_no_triangles():
    broken = SurfaceMesh(points=[(0, 0, 0), (1, 0, 0), (0, np.inf, 0)], triangles=[(0, 1, 2)])
    report = check(broken)
    assert "points[2]" in report.problems[0]
    json.loads(report.to_json())
    empty = check(SurfaceMesh(points=np.empty((0, 3)), triangles=np.empty((0, 3))))
    assert "no triangles" in empty.problems[0]
    json.loads(empty.to_json())
    str(empty)


def test_indices_out_of_range_are_refused():
    with pytest.raises(ValueError, match="not a mesh"):
        check(SurfaceMesh(points=np.eye(3), triangles=[(0, 1, 5)]))


def test_trimesh_agrees():
    mesh = icosphere(2)
    report, other = check(mesh), mesh.to_trimesh()
    assert other.is_watertight and other.is_winding_consistent
    assert report.euler == other.euler_number
    assert report.area == pytest.approx(other.area)
    assert report.volume == pytest.approx(other.volume)


def test_two_surfaces(saddle):
    report = check(saddle)
    assert report.faces == 2 and 0.95 < report.deviation_max / 0.125**2 < 1
    assert report.deviation_max == pytest.approx(
        check(changed(saddle, face_ids=None, surfaces=(Saddle(),))).deviation_max
    )


def test_json_and_text(saddle):
    mesh = changed(saddle, seconds={"packing": 0.5}, warnings=["mind the gap"])
    report = check(mesh)
    content = json.loads(report.to_json())
    promised = """nodes triangles euler closed manifold oriented alpha_mean alpha_min alpha_p01
    min_angle_deg quasi_unit_share length_mean length_std deviation_max deviation_rms area volume
    seconds warnings schema_version clean problems""".split()
    assert set(promised) <= set(content)
    assert content["seconds"]["packing"] == 0.5 and content["volume"] is None
    lines = str(report).splitlines()
    assert len(lines) < 25 and max(map(len, lines)) <= 110
    assert "clean" in lines[0] and "mind the gap" in lines[-1]
