"""Curves and surfaces of CAD faces in the core: what wrong arguments give, and what is shared.

Their values are compared with formulas in ``tests/geometry/cad_surfaces``.
"""

import numpy as np
import pytest

from surfmesh._core import surfaces
from surfmesh.geometry.cad_surfaces.elementary import Cylinder, Sphere
from surfmesh.geometry.cad_surfaces.offset import OffsetSurface
from surfmesh.geometry.core_surface import as_core_surface

ORIGIN, X, Y, Z = np.zeros(3), *np.eye(3)
DOMAIN = ((0.0, 1.0), (0.0, 1.0))
UV = np.random.default_rng(0).random((300, 2))  # more than are evaluated at a time


class Failing:
    """A surface of the caller's that raises."""

    name, domain, loops = "failing", DOMAIN, ()

    def evaluate(self, uv, order=0):
        raise ZeroDivisionError("mine")

    def derivative_bounds(self, lo, hi):
        return None


def test_a_face_surface_is_its_surface_of_the_core():
    cylinder = Cylinder(ORIGIN, X, Y, Z, 2.0, domain=DOMAIN)
    assert as_core_surface(cylinder) is cylinder.core
    assert cylinder.core.domain == DOMAIN
    assert np.array_equal(cylinder.core.evaluate(UV, 3), np.array(cylinder.evaluate(UV, 3)))
    assert cylinder.core.derivative_bounds(UV, UV) is None
    moved = cylinder.with_domain(((2.0, 3.0), (0.0, 1.0)))
    assert moved.core.domain == moved.domain


def test_blocks_of_points_change_no_bit():
    sphere = Sphere(ORIGIN, X, Y, Z, 2.0, domain=DOMAIN)
    together = sphere.core.evaluate(UV, 2)
    one_by_one = [sphere.core.evaluate(uv[None], 2)[:, 0] for uv in UV]
    assert np.array_equal(together, np.stack(one_by_one, axis=1))


def test_an_offset_passes_on_what_its_basis_raises():
    offset = surfaces.offset_surface(as_core_surface(Failing()), 0.1)
    with pytest.raises(ZeroDivisionError, match="mine"):
        offset.evaluate(UV)


def test_an_offset_has_no_third_derivatives():
    sphere = Sphere(ORIGIN, X, Y, Z, 2.0, domain=DOMAIN)
    offset = OffsetSurface(sphere, 0.5, domain=DOMAIN)
    with pytest.raises(ValueError, match="so high an order"):
        offset.core.evaluate(UV, 3)
    assert np.allclose(np.linalg.norm(offset.evaluate(UV)[0], axis=1), 2.5)


def test_curves_of_the_plane_sweep_no_surface():
    line = surfaces.line(np.zeros(2), np.array([1.0, 0.0]))
    with pytest.raises(ValueError, match="in space"):
        surfaces.extrusion(DOMAIN, line, Z)
    with pytest.raises(ValueError, match="in space"):
        surfaces.revolution(DOMAIN, line, ORIGIN, Z)
    with pytest.raises(ValueError, match="none in the plane"):
        surfaces.offset_curve(line, 1.0, Z, None)


def test_wrong_vectors_are_refused():
    with pytest.raises(TypeError):
        surfaces.plane(DOMAIN, ORIGIN[:2], X, Y)
    with pytest.raises(ValueError, match="rows"):
        surfaces.line(np.zeros(3), np.zeros(2))
    with pytest.raises(ValueError, match="two or three"):
        surfaces.line(np.zeros(4), np.zeros(4))
    with pytest.raises(ValueError, match="order"):
        surfaces.line(ORIGIN, X).evaluate(np.zeros(3), -1)


def test_points_in_rows_change_no_bit():
    rng = np.random.default_rng(3)
    knots = np.array([0.0, 0.0, 0.0, 0.4, 1.0, 1.0, 1.0])
    spline = surfaces.spline_surface(
        DOMAIN, knots, knots, rng.random((4, 4, 3)), rng.uniform(1, 2, (4, 4)), (0.0, 0.0)
    )
    u, v = np.meshgrid(rng.random(9), rng.random(5), indexing="ij")
    for grid in (np.stack([u, v], axis=-1), np.stack([u.T, v.T], axis=-1)):
        uv = grid.reshape(-1, 2)
        alone = [spline.evaluate(pair[None], 2)[:, 0] for pair in uv]
        assert np.array_equal(spline.evaluate(uv, 2), np.stack(alone, axis=1))
