"""Pictures: written without a display, not blank, nothing on the console."""

import numpy as np
import pytest
from handmade_meshes import Saddle, changed, grid
from matplotlib.image import imread

from surfmesh.errors import FileFormatError, SurfmeshError
from surfmesh.view import legend, opengl, picture, plot, show
from surfmesh.view.camera import framed
from surfmesh.view.colouring import COLOURS, colouring, colourings_of


def painted_share(path):
    pixels = imread(path)[..., :3]
    return float((np.ptp(pixels, axis=-1) > 0.1).mean())  # neither white nor grey


@pytest.mark.parametrize("drawn_by", ["opengl", "painter"])
def test_picture_is_not_blank(drawn_by, saddle, tmp_path, monkeypatch, capfd):
    if drawn_by == "painter":
        monkeypatch.setattr(picture, "can_draw", lambda: False)
    path = plot(saddle, tmp_path / "saddle.png", by="size", size=(400, 300))
    assert imread(path).shape[:2] == (300, 400)
    assert painted_share(path) > 0.1
    assert capfd.readouterr() == ("", "")
    assert [entry.name for entry in tmp_path.iterdir()] == ["saddle.png"]


def test_a_vtk_that_needs_a_display_is_not_asked_to_draw_without(monkeypatch):
    """VTK 9.3, which OCP 7.8 comes with, ends the process instead."""
    monkeypatch.setattr("sys.platform", "linux")
    monkeypatch.setattr(opengl, "_vtk_version", lambda: (9, 3))
    monkeypatch.delenv("DISPLAY", raising=False)
    assert not opengl.can_draw.__wrapped__()
    monkeypatch.setenv("DISPLAY", ":0")
    assert opengl.can_draw.__wrapped__()


@pytest.mark.parametrize("by", COLOURS)
def test_colourings_have_a_value_for_each(by, saddle):
    found = colouring(saddle, by)
    assert len(found.values) == len(saddle.points if found.per_vertex else saddle.triangles)
    assert found.limits[0] < found.limits[1] and found.title


def test_curvature_of_the_saddle():
    mesh = grid(Saddle(), 2)
    found = colouring(mesh, "curvature")
    assert found.values[4] == pytest.approx(2)  # at the middle k = +2, -2


def test_what_cannot_be_shown_is_refused(saddle, tmp_path, monkeypatch):
    with pytest.raises(ValueError, match="cannot colour by 'colour'"):
        plot(saddle, tmp_path / "a.png", by="colour")
    bare = changed(saddle, surfaces=(), sizes=None)
    for by in ("size", "deviation", "curvature"):
        with pytest.raises(ValueError, match=by):
            plot(bare, tmp_path / "a.png", by=by)
    with pytest.raises(FileFormatError, match=r"written as \.png"):
        plot(saddle, tmp_path / "a.jpg")
    with pytest.raises(FileFormatError, match="does not exist"):
        plot(saddle, tmp_path / "b" / "a.png")
    monkeypatch.delenv("DISPLAY", raising=False)
    monkeypatch.delenv("WAYLAND_DISPLAY", raising=False)
    monkeypatch.setattr("sys.platform", "linux")
    with pytest.raises(SurfmeshError, match="no display"):
        show(saddle)
    assert not list(tmp_path.iterdir())


@pytest.mark.parametrize("stretch", [(1, 1, 1), (1, 1, 0), (1, 1e-6, 1), (1e9, 1e9, 1e9)])
def test_camera_holds_the_mesh(stretch):
    points = np.random.default_rng(0).normal(size=(50, 3)) * stretch
    camera = framed(points, 4 / 3)
    relative = points - camera.centre
    assert np.abs(relative @ camera.up).max() <= camera.half_height
    assert np.abs(relative @ camera.right).max() <= camera.half_height * 4 / 3
    axes = np.array([camera.right, camera.up, camera.towards])
    np.testing.assert_allclose(axes @ axes.T, np.eye(3), atol=1e-12)


def test_edges_are_drawn_when_they_can_be_told_apart(saddle, monkeypatch):
    assert legend.with_edges(saddle, None) and not legend.with_edges(saddle, False)
    monkeypatch.setattr(legend, "EDGES_UP_TO", 10)
    assert not legend.with_edges(saddle, None) and legend.with_edges(saddle, True)


def test_faces_keep_their_hues():
    mesh = grid(Saddle(), 4, face_ids=np.arange(32), surfaces=())
    found = colouring(mesh, "face")
    assert found.hues == 20 and found.values.max() == 19 and "modulo 20" in found.title
    few = colouring(changed(mesh, face_ids=np.arange(32) % 3), "face")
    assert few.hues == 3 and few.limits == (-0.5, 2.5)


def test_what_is_the_same_everywhere_looks_so(saddle):
    nearly = changed(saddle, sizes=np.linspace(0.3, 0.303, 81))
    low, high = colouring(nearly, "size").limits
    assert high > 1.2 * low and low < 0.3 < 0.303 < high


def test_zero_curvature_is_zero_and_can_be_drawn(saddle):
    found = colouring(changed(saddle, sizes=np.r_[1e-9, np.geomspace(0.1, 90, 80)]), "size")
    assert found.logarithmic and found.values.min() == 1e-9
    assert found.within.min() == found.limits[0] > 1e-3


def test_all_colourings_at_once_are_the_single_ones(saddle):
    for by, found in colourings_of(saddle).items():
        np.testing.assert_array_equal(found.values, colouring(saddle, by).values)


@pytest.mark.parametrize("drawn_by", ["opengl", "painter"])
def test_lines_are_drawn(drawn_by, saddle, tmp_path, monkeypatch):
    if drawn_by == "painter":
        monkeypatch.setattr(picture, "can_draw", lambda: False)
    options = {"by": "mean", "edges": False, "size": (400, 300), "title": ""}
    bare = imread(plot(saddle, tmp_path / "bare.png", **options))
    for extra in ({"circles": True}, {"directions": True}, {"worst": 3}):
        drawn = imread(plot(saddle, tmp_path / "drawn.png", **options, **extra))
        assert (np.abs(drawn - bare)[60:] > 0.2).any(axis=-1).sum() > 50, extra


def test_a_window_is_opened_where_there_is_a_display(saddle, monkeypatch):
    opened = []

    class Window:
        def show(self):
            opened.append("shown")

    def stand_in(drawn, off_screen):
        layers = [layer.name for layer in drawn.lines]
        opened.append((drawn.colours.title, layers, drawn.edges))
        return Window()

    monkeypatch.setattr("surfmesh.view.scene.scene", stand_in)
    monkeypatch.setenv("DISPLAY", ":0")
    saddle.show(by="size", circles=True, worst=2)
    names = ["circles of the packing", "model edges", "the 2 worst triangles"]
    assert opened == [("wanted edge length (model units)", names, False), "shown"]
