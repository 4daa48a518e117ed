"""Polygons in space closed by triangles between their corners."""

from types import SimpleNamespace

import numpy as np
import pytest

from surfmesh.geometry.cad_surfaces.elementary import Plane
from surfmesh.meshing.faces.face_data import CoedgeNodes, FaceJob, FaceMesh, boundary_of
from surfmesh.meshing.faces.face_mesh import _never_empty, mesh_face
from surfmesh.meshing.faces.polygon_filling import filled
from surfmesh.sizing.options.sizing import Sizing


def areas(points, triangles):
    a, b, c = points[triangles].transpose(1, 0, 2)
    return 0.5 * np.cross(b - a, c - a)


def test_a_flat_polygon_is_covered_once():
    angle = 2.0 * np.pi * np.arange(17) / 17
    radius = 2.0 + np.cos(3.0 * angle)
    points = np.stack([radius * np.cos(angle), radius * np.sin(angle), 0.0 * angle], axis=1)
    found = areas(points, filled(points))[:, 2]
    x, y, _ = points.T
    assert len(found) == 15 and (found > 0.0).all()
    assert found.sum() == pytest.approx(0.5 * (x @ np.roll(y, -1) - y @ np.roll(x, -1)))


def test_the_shorter_diagonal_of_a_bent_square_is_taken():
    points = np.array([[0, 0, 0], [1, 0, 0.5], [1.2, 1.2, 0], [0, 1, 0.5]])
    triangles = filled(points)
    shared = set(triangles[0]) & set(triangles[1])
    other = [(0, 1, 3), (1, 2, 3)] if shared == {0, 2} else [(0, 1, 2), (0, 2, 3)]
    assert (
        np.linalg.norm(areas(points, triangles), axis=1).sum()
        <= np.linalg.norm(areas(points, np.array(other)), axis=1).sum()
    )


SQUARE = np.array([[0.0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0], [0, 0, 0]])


def square_with(images, last):
    """A good square in space, whose images (5, 2) are none; its mesh, with points in space."""
    pieces = tuple(
        CoedgeNodes(images[k : k + 2], np.array([k, (k + 1) % 4]), SQUARE[k : k + 2], np.ones(2))
        for k in range(4)
    )
    plane = Plane(np.zeros(3), *np.eye(3), domain=((0.0, 1.0), (0.0, 1.0)))
    found = mesh_face(FaceJob(plane, boundary_of((pieces,)), Sizing(size=2.0), last=last))
    points = np.concatenate([piece.points for piece in pieces])[found.slots]
    return found, np.linalg.norm(areas(points, found.triangles), axis=1).sum()


def test_images_that_cross_by_far_are_parted_the_last_time():
    images = SQUARE[[0, 2, 1, 3, 0], :2]
    assert "crosses itself" in square_with(images, last=False)[0].failure
    found, area = square_with(images, last=True)
    assert not found.failure and area == pytest.approx(1.0)


def test_images_without_area_are_closed_in_space_the_last_time():
    images = np.array([[0, 0], [1.0, 1.0], [0, 0], [1.0, 1.0], [0, 0]])
    assert square_with(images, last=False)[0].failure
    found, area = square_with(images, last=True)
    assert not found.failure and "off the surface" in found.remark
    assert area == pytest.approx(1.0)


@pytest.mark.parametrize(
    "back, said", [([1, 0], "neighbours meet"), ([1, 2, 0], "nothing is left")]
)
def test_a_face_without_triangles_says_why(back, said):
    """There and back on the same segments leaves no hole, another way back does."""
    place = np.zeros((len(back), 3))
    there = CoedgeNodes(np.zeros((2, 2)), np.array([0, 1]), np.zeros((2, 3)), np.ones(2))
    again = CoedgeNodes(place[:, :2], np.array(back), place, np.ones(len(back)))
    job = FaceJob(SimpleNamespace(kind="plane"), boundary_of(((there, again),)), Sizing())
    mesh = _never_empty(job, FaceMesh())
    assert said in mesh.remark + mesh.failure
    assert bool(mesh.failure) == (said == "nothing is left")
