"""Lines over the colours: circles that touch, directions that are principal, edges of models."""

import sys
import types

import numpy as np
import pytest
from handmade_meshes import Saddle, changed, grid, icosphere

import surfmesh as sm
from surfmesh.result.surface_mesh import SurfaceMesh
from surfmesh.sizing.metric_roots import unpacked
from surfmesh.view import show
from surfmesh.view.drawing import drawing
from surfmesh.view.lines import circles, model_edges, principal_directions, worst_triangles
from surfmesh.view.overlays import overlays
from surfmesh.view.scene import scene


def flat_triangle(sizes):
    points = [(0, 0, 0), (1, 0, 0), (0.5, 0.75**0.5, 0)]
    return SurfaceMesh(points=points, triangles=[(0, 1, 2)], sizes=sizes)


def test_circles_have_the_wanted_diameter():
    mesh = icosphere(2)
    mesh = changed(mesh, sizes=np.linspace(0.1, 0.2, len(mesh.points)))
    ends = circles(mesh).segments.reshape(-1, 3)
    distance = np.linalg.norm(ends[:, None] - mesh.points, axis=2)
    np.testing.assert_allclose((distance / (0.5 * mesh.sizes)).min(axis=1), 1, atol=1e-9)


def test_circles_of_unit_edges_touch_in_their_middles():
    ends = circles(flat_triangle(np.ones(3))).segments.reshape(-1, 3)
    for middle in ((0.5, 0, 0), (0.25, 0.75**0.5 / 2, 0), (0.75, 0.75**0.5 / 2, 0)):
        assert np.isclose(ends, middle, atol=1e-12).all(axis=1).sum() == 2  # one from each


def test_circles_stay_on_their_triangles():
    ends = circles(flat_triangle(np.array([1.0, 1.0, 1.9]))).segments.reshape(-1, 3)
    assert ends[:, 1].min() > -1e-12  # the third would reach beyond the side opposite
    assert len(circles(flat_triangle(np.full(3, 9.0))).segments) == 0
    with pytest.raises(ValueError, match="no wanted sizes"):
        circles(changed(flat_triangle(np.ones(3)), sizes=None))


def test_directions_of_a_torus_are_its_circles():
    """A torus bends least along the parallels on its outside, most along the meridians."""
    torus = sm.ParametricSurface(
        "(3 + cos(v))*cos(u)", "(3 + cos(v))*sin(u)", "sin(v)", u=(0, 6), v=(-1, 1)
    )
    mesh = grid(torus, 12)
    lines = principal_directions(mesh)
    assert {layer.name for layer in lines} == {"direction of k1", "direction of k2"}
    flattest, roundest = lines  # outward normal: both negative, so the larger is the flatter
    middle = flattest.segments.mean(axis=1)
    along = np.diff(flattest.segments, axis=1)[:, 0]
    across = np.diff(roundest.segments, axis=1)[:, 0]
    parallel = np.cross((0, 0, 1), middle)
    for found in (along, parallel):
        found /= np.linalg.norm(found, axis=1, keepdims=True)
    np.testing.assert_allclose(np.abs((along * parallel).sum(axis=1)), 1, atol=1e-9)
    np.testing.assert_allclose((along * across).sum(axis=1), 0, atol=1e-9)


def test_a_sphere_and_a_plane_have_no_directions():
    flat = sm.ParametricSurface("u", "v", "0*u", u=(0, 1), v=(0, 1))
    for mesh in (icosphere(1), grid(flat, 3)):
        assert [len(layer.segments) for layer in principal_directions(mesh)] == [0, 0]
    with pytest.raises(ValueError, match="no surface"):
        principal_directions(changed(grid(Saddle(), 2), surfaces=()))


def test_many_directions_are_thinned_out():
    first, _ = principal_directions(grid(Saddle(), 80))
    assert 400 < len(first.segments) <= 1500
    middle = first.segments.mean(axis=1)
    assert np.abs(middle).max() <= 2 and len(np.unique(middle, axis=0)) == len(middle)


def test_model_edges_are_boundary_and_borders(saddle, tetrahedron):
    rim = 4 * 8
    assert len(model_edges(changed(saddle, face_ids=None)).segments) == rim
    left = saddle.points[saddle.triangles].mean(axis=1)[:, 0] < 0
    assert len(model_edges(changed(saddle, face_ids=left)).segments) == rim + 8
    assert len(model_edges(tetrahedron).segments) == 0
    chosen = SurfaceMesh(
        points=saddle.points, triangles=saddle.triangles, edge_segments=[(0, 1)], edge_ids=[0]
    )
    np.testing.assert_array_equal(model_edges(chosen).segments, saddle.points[[[0, 1]]])


def test_the_worst_are_marked_worst_first():
    mesh = icosphere(1)
    points = mesh.points.copy()
    points[mesh.triangles[7, 0]] *= 3
    lines, numbers = worst_triangles(changed(mesh, points=points), 3)
    assert len(lines.segments) == 9
    assert all(mesh.triangles[7, 0] in mesh.triangles[t] for t in numbers)


def test_what_is_drawn_over_what(saddle):
    def names(by, **asked):
        asked = {"draw_circles": False, "directions": False, "worst": None} | asked
        return [layer.name for layer in overlays(saddle, by, **asked)]

    assert names("alpha") == ["model edges", "the 10 worst triangles"]
    assert names("face") == ["model edges"]
    assert names("face", worst=2, draw_circles=True, directions=True) == [
        "circles of the packing", "direction of k1", "direction of k2", "model edges",
        "the 2 worst triangles",
    ]  # fmt: skip


@pytest.mark.parametrize("sizing, by", [(None, "curvature"), (0.3, "size")])
def test_a_surface_is_shown_before_it_is_meshed(sizing, by, tmp_path, monkeypatch):
    asked = {}
    monkeypatch.setattr("surfmesh.view.plot", lambda mesh, path, **given: asked.update(given))
    surface = sm.ParametricSurface("u", "v", "u*v", u=(-1, 1), v=(-1, 1), name="saddle")
    sm.show(surface, sizing, path=tmp_path / "a.png", circles=True)
    assert asked["by"] == by and asked["directions"] and asked["circles"]
    assert asked["title"].startswith("saddle: ") and asked["title"].endswith(" circles")


def test_a_mesh_is_shown_as_it_is(saddle, tmp_path):
    path = tmp_path / "a.png"
    sm.show(saddle, path=path, by="mean", size=(200, 150))
    assert path.stat().st_size > 1000


def test_a_notebook_gets_a_page_within_its_page(saddle, monkeypatch):
    shown = []
    display = types.SimpleNamespace(HTML=str, display=shown.append)
    shell = types.SimpleNamespace(kernel=object())
    monkeypatch.setitem(sys.modules, "IPython", types.SimpleNamespace(get_ipython=lambda: shell))
    monkeypatch.setitem(sys.modules, "IPython.display", display)
    show(saddle, by="size", circles=True)
    (widget,) = shown
    assert widget.startswith('<div><iframe sandbox="allow-scripts"')
    assert "&lt;!DOCTYPE html&gt;" in widget and "<script" not in widget
    switched_on = "[&quot;triangles&quot;, &quot;circles&quot;, &quot;model edges&quot;]"
    assert f"&quot;shown&quot;: {switched_on}" in widget


def test_scene_has_a_line_actor_for_each_layer(saddle):
    from surfmesh.view.opengl import can_draw

    if not can_draw():
        pytest.skip("no OpenGL on this machine")
    drawn = drawing(saddle, (200, 150), by="size", circles=True, directions=True, worst=1)
    plotter = scene(drawn, off_screen=True)
    lines = [a for a in plotter.actors.values() if getattr(a, "mapper", None) is not None]
    assert len(drawn.lines) == 5 and len(lines) >= 6
    plotter.close()


def test_circles_are_ellipses_where_sizes_have_a_direction():
    """Every piece lies half a wanted length from some vertex, in the tensor of that vertex."""
    tube = sm.ParametricSurface("cos(u)", "sin(u)", "v", u=(0, "2*pi"), v=(0, 20))
    mesh = sm.mesh(tube, sm.Sizing(chord=0.02, anisotropy=4))
    row = np.empty(len(mesh.points), int)
    row[mesh.triangles] = mesh.uv_triangles
    wanted = unpacked(mesh.metric_root_3d[row])
    ends = circles(mesh).segments[::97, 0]
    away = np.einsum("vij,evj->evi", wanted, ends[:, None] - mesh.points)
    nearest = np.abs(np.linalg.norm(away, axis=2) - 0.5).min(axis=1)
    assert np.median(nearest) < 1e-9
