"""Where no chord says how far vertices may be, they lie on their surface."""

import cadquery as cq
import numpy as np
import pytest

import surfmesh as sm

BOX = cq.Workplane().box(2, 2, 2)
TUBE = cq.Workplane().cylinder(2, 1)


def moved(mesh, way):
    """One vertex within a face moved by ``way``."""
    inner = np.setdiff1d(np.arange(len(mesh.points)), mesh.edge_segments)
    points = mesh.points.copy()
    points[inner[0]] += way
    return mesh.replaced(points=points), int(inner[0])


@pytest.mark.parametrize("part", [BOX, TUBE], ids=["box", "tube"])
@pytest.mark.parametrize("sizes", [{"size": 0.5}, {"angle": 30, "max_size": 0.5}], ids=str)
def test_a_vertex_off_its_surface_is_seen_without_a_chord(part, sizes):
    mesh = sm.mesh(part, **sizes)
    assert sm.check(mesh).clean
    broken, vertex = moved(mesh, (0.05, 0.06, 0.07))
    said = sm.check(broken).problems
    assert any("1 vertex off the surface, by up to 0.0" in one for one in said)
    assert any(f"vertex {vertex} at" in one for one in said)


def test_balanced_vertices_are_meant_to_be_off_the_surface():
    mesh = sm.mesh("sphere", size=0.4, vertices="balanced")
    assert sm.check(mesh).clean


def test_what_slides_along_its_surface_stays_on_it():
    mesh = sm.mesh(BOX, size=0.5)
    inner = np.setdiff1d(np.arange(len(mesh.points)), mesh.edge_segments)
    top = inner[np.argmax(mesh.points[inner, 2])]
    points = mesh.points.copy()
    points[top, :2] += 0.01
    assert sm.check(mesh.replaced(points=points)).clean
