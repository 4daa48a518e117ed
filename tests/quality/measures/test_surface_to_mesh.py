"""The distance of the true surface from the mesh, on rims and between the mesh's samples."""

from dataclasses import replace

import cadquery as cq
import numpy as np
import pytest
from handmade_meshes import Saddle, changed, grid, icosphere
from hypothesis import given, settings
from hypothesis import strategies as st
from naive import surface_to_mesh as naive

import surfmesh as sm
from surfmesh._core.space import triangle_distances
from surfmesh.quality.measures import surface_to_mesh
from surfmesh.quality.measures.measurements import Measurements

CELLS = 8


def segments_looked_at_everywhere(monkeypatch):
    """A list that holds, after each search, how many segments their middles have not settled."""
    looked_at, look = [], surface_to_mesh.look_along_edges
    monkeypatch.setattr(
        surface_to_mesh, "look_along_edges", lambda *given: looked_at.append(look(*given))
    )
    return looked_at


def sector(scale=1.0, turn=2.0):
    """A flat ring sector: nothing but its rims is off the mesh."""
    return sm.ParametricSurface(
        f"{scale!r}*u*cos(v)", f"{scale!r}*u*sin(v)", "0*u", u=(1, 2), v=(0, turn), name="sector"
    )


def coarse(surface, **sizing):
    asked = sm.Sizing(**{"size": 0.3} | sizing)
    return grid(surface, CELLS, sizing=asked, sizes=np.full((CELLS + 1) ** 2, 0.3))


@pytest.mark.parametrize("scale", [1e-3, 1.0, 1e3])
@pytest.mark.parametrize("turn", [0.5, 2.0])
def test_the_sag_of_a_rim_is_found_in_full(scale, turn):
    report = sm.check(coarse(sector(scale, turn)))
    sag = 2 * scale * (1 - np.cos(turn / CELLS / 2))
    assert report.surface_deviation_max == pytest.approx(sag, rel=1e-6)
    assert report.surface_deviation_at_rim and report.deviation_two_sided == pytest.approx(sag)
    assert np.linalg.norm(report.surface_deviation_point) == pytest.approx(2 * scale)
    assert report.surface_deviation_uv[0] == pytest.approx(2.0)
    assert report.deviation_max < sag  # the mesh itself lies in the plane, but for the inner rim


def test_a_rim_beyond_the_chord_is_a_problem():
    sag = 2 * (1 - np.cos(2.0 / CELLS / 2))
    report = sm.check(coarse(sector(), chord=0.9 * sag))
    (problem,) = report.problems
    assert problem.startswith(f"the surface lies up to {sag:.4g} from the mesh")
    assert "on a rim at (" in problem
    assert "the surface lies up to" in str(report)
    assert sm.check(coarse(sector(), chord=1.01 * sag)).clean


def test_a_min_size_that_forbids_it_is_a_stated_limit():
    sag = 2 * (1 - np.cos(2.0 / CELLS / 2))
    report = sm.check(coarse(sector(), chord=0.5 * sag, min_size=0.29))
    (limit,) = report.limits
    assert report.clean and limit.reached == pytest.approx(sag) and limit.option == "chord"


def test_a_sphere_is_as_far_from_the_mesh_as_the_mesh_from_it():
    report = sm.check(icosphere(2))
    assert report.surface_deviation_max == pytest.approx(report.deviation_max, rel=0.01)
    assert not report.surface_deviation_at_rim


def test_inside_the_saddle_both_ways_agree_but_rims_bend_in_space():
    report = sm.check(grid(Saddle(), 16))
    assert report.surface_deviation_max == pytest.approx(report.deviation_max, rel=0.05)


def test_a_part_between_the_samples_of_a_triangle_is_seen_from_the_surface():
    def ridge(u, v):  # a wall along u = 0.29, between corners, middles and centroids
        return u, v, 0.5 * np.exp(-(((u - 0.29) / 0.03) ** 2))

    surface = sm.NumericSurface(ridge, u=(-1, 1), v=(-1, 1), name="ridge")
    report = sm.check(grid(surface, 4))
    assert report.surface_deviation_max > 0.25  # none of the mesh's samples lies at the ridge
    assert report.surface_deviation_max > 2 * report.deviation_max


def test_without_surfaces_nothing_is_claimed(saddle):
    report = sm.check(changed(saddle, surfaces=(), uv_points=None, uv_triangles=None))
    assert report.surface_deviation_max is None and report.deviation_two_sided is None


def test_all_of_the_surface_lies_as_near_as_the_report_says():
    surface = sm.load("monkey_saddle")
    mesh = sm.mesh(surface, sm.Sizing(chord=0.01))
    report = sm.check(mesh)
    rng = np.random.default_rng(1)
    uv = rng.uniform(*np.transpose(surface.domain), (400, 2))
    uv[:200, 0] = np.where(rng.random(200) < 0.5, *surface.domain[0])
    (points,) = surface.evaluate(uv, 0)
    corners = mesh.points[mesh.triangles]
    for point in points:
        away = triangle_distances(np.broadcast_to(point, (len(corners), 3)), corners).min()
        assert away <= 1.03 * report.surface_deviation_max
    assert report.clean and report.deviation_two_sided <= 0.01


@settings(max_examples=40)
@given(
    st.lists(st.floats(-1, 1), min_size=12, max_size=12),
    st.sampled_from([1.0, 1e-3]),
)
def test_the_distance_from_a_triangle(numbers, flat):
    point, corners = np.reshape(numbers, (4, 3))[:1], np.reshape(numbers, (4, 3))[None, 1:]
    corners = corners * [1.0, flat, 1.0]
    found = triangle_distances(point, corners)[0]
    n = 30
    weights = np.array([(i, j, n - i - j) for i in range(n + 1) for j in range(n + 1 - i)]) / n
    sampled = np.linalg.norm(weights @ corners[0] - point, axis=1).min()
    longest = np.ptp(corners[0], axis=0).max()
    if np.linalg.norm(np.cross(*(corners[0, 1:] - corners[0, 0]))) > 1e-9:
        assert sampled - 2 * longest / n - 1e-12 <= found <= sampled + 1e-9


@pytest.mark.parametrize("ratio", [1.0, 5.0])
def test_edges_of_cad_sheets_are_looked_at_along_their_curves(ratio):
    disc = cq.Face.makeFromWires(cq.Wire.makeCircle(3, cq.Vector(), cq.Vector(0, 0, 1)))
    mesh = sm.mesh(disc, sm.Sizing(chord=0.02, anisotropy=ratio))
    report = sm.check(mesh)
    rim = mesh.points[mesh.boundary_edges].mean(axis=1)
    sag = 3.0 - np.linalg.norm(rim, axis=1).min()
    assert report.surface_deviation_max == pytest.approx(sag, rel=1e-3)
    assert report.clean and report.surface_deviation_at_rim and report.deviation_max < 1e-9
    assert np.linalg.norm(report.surface_deviation_point) == pytest.approx(3.0)
    tighter = mesh.sizing.replaced(chord=0.5 * sag)
    coarse = sm.check(replace(mesh, sizing=tighter, promises=None))
    assert not coarse.clean and "on a rim" in coarse.problems[0]


@pytest.mark.parametrize("moved", [0.0, 1e-3, 0.03, 0.3])
@pytest.mark.parametrize("squeezed", [1.0, 0.6])
def test_middles_of_arcs_say_as_much_as_all_points_of_them(moved, squeezed, monkeypatch):
    """On circles and ellipses, where vertices lie in their places and where they do not."""
    plate = cq.Workplane().box(8, 6, 1).faces(">Z").workplane()
    part = plate.ellipse(2, 2 * squeezed).cutThruAll().edges("|Z").fillet(1)
    mesh = sm.mesh(part, sm.Sizing(size=0.8), jobs=1)
    draw = np.random.default_rng(1)
    nodes = draw.choice(len(mesh.points), 9, replace=False)
    points = mesh.points.copy()
    points[nodes] += moved * draw.normal(size=(9, 3))
    mesh = mesh.replaced(points=points)
    settled = Measurements(mesh).surface_deviation
    monkeypatch.setattr(surface_to_mesh, "BESIDE_MIDDLE", np.inf)  # nothing is settled
    looked_at = segments_looked_at_everywhere(monkeypatch)
    everywhere = Measurements(mesh).surface_deviation
    assert looked_at[0] > 30
    np.testing.assert_allclose(settled.by_triangle, everywhere.by_triangle, rtol=1e-9, atol=1e-12)
    assert settled.largest == pytest.approx(everywhere.largest, rel=1e-12)


def test_most_arcs_are_settled_by_their_middles(monkeypatch):
    part = cq.Workplane().circle(4).extrude(1).faces(">Z").workplane().hole(1)
    mesh = sm.mesh(part, sm.Sizing(size=0.5), jobs=1)
    looked_at = segments_looked_at_everywhere(monkeypatch)
    assert Measurements(mesh).surface_deviation.largest > 0.0
    assert 4 * looked_at[0] <= np.count_nonzero(mesh.edge_segment_rows >= 0)


@pytest.mark.parametrize("harm", ["none", "shaken", "thrown", "tighter"])
@pytest.mark.parametrize("subject", ["torus", "monkey_saddle", "part", "sheet"])
def test_the_search_is_that_of_plain_python(subject, harm):
    """To the last bit, also where points lie beyond the chord and beside their faces."""
    plate = cq.Workplane().box(4, 3, 1).faces(">Z").workplane().hole(1).edges("|Z").fillet(0.4)
    disc = cq.Face.makeFromWires(cq.Wire.makeCircle(3, cq.Vector(), cq.Vector(0, 0, 1)))
    given = {"part": plate, "sheet": disc}.get(subject) or sm.load(subject)
    mesh = sm.mesh(given, sm.Sizing(chord=0.02), jobs=1)
    draw = np.random.default_rng(3)
    if harm == "tighter":
        mesh = mesh.replaced(sizing=mesh.sizing.replaced(chord=0.005), promises=None)
    elif harm != "none":
        nodes = draw.choice(len(mesh.points), 3, replace=False)
        points = mesh.points.copy()
        points[nodes] += {"shaken": 0.03, "thrown": 2.0}[harm] * draw.normal(size=(3, 3))
        mesh = mesh.replaced(points=points)
    measured = Measurements(mesh)
    found = measured.surface_deviation
    expected = naive.surface_deviation(measured.known, measured.deviation, measured.tolerances)
    np.testing.assert_array_equal(found.by_triangle, expected.by_triangle)
    assert found[1:] == expected[1:]
