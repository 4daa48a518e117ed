"""Splines as polynomials over their knot spans: the same points, to rounding, in fewer steps."""

import numpy as np
import pytest
from handmade_meshes import grid
from hypothesis import given, settings
from hypothesis import strategies as st

from surfmesh._core import surfaces
from surfmesh._core.quality import prepared_surfaces
from surfmesh.geometry.cad_surfaces.nurbs import BSplineSurface
from surfmesh.quality.measures.deviation import deviation
from surfmesh.quality.measures.known_surfaces import KnownSurfaces
from surfmesh.quality.measures.off_surface import off_surface
from surfmesh.quality.measures.surface_to_mesh import surface_deviation
from surfmesh.quality.measures.tolerances import Tolerances
from surfmesh.result.surface_mesh import SurfaceMesh
from surfmesh.sizing.options.sizing import Sizing

UNIT = ((0.0, 1.0), (0.0, 1.0))
MANY = np.zeros(4000, np.int32)  # triangles, all of one face


def clamped(degree, inner=()):
    """Knots from 0 to 1."""
    return np.concatenate([np.zeros(degree + 1), inner, np.ones(degree + 1)])


def spline(knots, control, domain=UNIT, periods=(0.0, 0.0), weights=None):
    return surfaces.spline_surface(domain, *knots, control, weights, periods)


def prepared(surface, faces=MANY):
    (found,) = prepared_surfaces([surface], faces)
    return found


def smooth_control(rng, shape):
    """As those of shapes are: not far from even."""
    even = np.stack(np.meshgrid(*(np.linspace(0, 1, n) for n in shape), [0.0], indexing="ij"), -1)
    return even.reshape(*shape, 3) + rng.normal(0.0, 0.2, (*shape, 3))


def assert_alike(surface, uv):
    polynomials = prepared(surface)
    assert polynomials is not surface
    assert polynomials.domain == surface.domain
    for order in range(3):
        one, other = surface.evaluate(uv, order), polynomials.evaluate(uv, order)
        for k, values in enumerate(one):
            within = 1e-13 * (1.0 + np.abs(values).max())
            np.testing.assert_allclose(other[k], values, rtol=0.0, atol=within)


@settings(deadline=None, max_examples=40)
@given(st.integers(1, 8), st.integers(1, 8), st.integers(0, 3), st.integers(0, 10_000))
def test_points_and_derivatives_are_those_of_the_spline(degree_u, degree_v, inner, seed):
    rng = np.random.default_rng(seed)
    knots = [clamped(d, np.linspace(0, 1, inner + 2)[1:-1]) for d in (degree_u, degree_v)]
    shape = [len(k) - d - 1 for k, d in zip(knots, (degree_u, degree_v))]
    surface = spline(knots, smooth_control(rng, shape))
    places = [*rng.uniform(-0.01, 1.01, 30), *np.linspace(0, 1, inner + 2)]  # at knots, beside
    assert_alike(surface, rng.choice(places, (61, 2)))
    assert_alike(surface, rng.choice(places, (1, 2)))


def kinked(domain, periods=(0.0, 0.0)):
    """|u| from -1 to 1."""
    knots = np.array([-1.0, -1.0, 0.0, 1.0, 1.0]), clamped(1)
    control = np.array([[[1.0, 0, v], [0, 1, v], [1, 2, v]] for v in (0.0, 1.0)])
    return spline(knots, np.ascontiguousarray(control.transpose(1, 0, 2)), domain, periods)


@pytest.mark.parametrize(
    "ends, period",
    [((-1.0, 1.0), 0.0), ((-1.0, 0.0), 0.0), ((0.0, 1.0), 0.0), ((0.0, 1.0), 2.0)]
    + [((1.0, 3.0), 2.0), ((-3.0, -1.0), 2.0), ((0.5, 1.5), 2.0)],
)
def test_at_creases_and_seams_the_spans_are_those_of_the_spline(ends, period):
    u = np.array([-3, -2, -1, -1e-14, 0, 1e-14, 0.1, 0.5, 1, 1.2, 1.5, 2, 3, 4.25])
    uv = np.column_stack([u, np.linspace(0, 1, len(u))])  # beyond the domain too
    assert_alike(kinked((ends, (0.0, 1.0)), (period, 0.0)), uv)


def test_only_splines_with_many_triangles_on_each_polynomial_are_prepared():
    rng = np.random.default_rng(1)
    knots = clamped(3, [0.5]), clamped(2)
    surface = spline(knots, smooth_control(rng, (5, 3)))
    plane = surfaces.plane(UNIT, np.zeros(3), np.eye(3)[0], np.eye(3)[1])
    given_surfaces = [plane, surface, surface]
    found = prepared_surfaces(given_surfaces, np.repeat([0, 1, 2], [90, 7, 8]).astype(np.int32))
    assert [a is b for a, b in zip(found, given_surfaces)] == [True, True, False]
    with pytest.raises(ValueError, match="faces"):
        prepared_surfaces([surface], np.ones(4, np.int32))


def test_rational_ones_stay_as_they_are():
    control = smooth_control(np.random.default_rng(2), (3, 3))
    rational = spline((clamped(2), clamped(2)), control, weights=np.full((3, 3), 2.0))
    assert prepared(rational) is rational


def test_where_powers_would_lose_digits_the_spline_stays():
    wild = np.random.default_rng(3).uniform(-1, 1, (21, 2, 3))  # coefficients of many sizes
    surface = spline((clamped(20), clamped(1)), wild)
    assert prepared(surface) is surface


def loft(shift=0.0):
    """Of degrees 8 and 1, in triangles, one vertex of which may lie off it, another's (u, v)."""
    rng = np.random.default_rng(4)
    surface = BSplineSurface(clamped(8), clamped(1), smooth_control(rng, (9, 2)), domain=UNIT)
    flat = grid(surface, 9)
    points, uv = flat.points.copy(), flat.uv_points.copy()
    points[37] += shift
    uv[52] += 0.3 * shift
    return SurfaceMesh(
        points=points,
        triangles=flat.triangles,
        uv_points=uv,
        surfaces=(surface,),
        sizing=Sizing(size=0.1),
    )


@pytest.mark.parametrize("shift", [0.0, 1e-3, 0.2])
def test_a_report_measures_the_same(shift):
    mesh = loft(shift)
    corners = mesh.points[mesh.triangles]
    area = 0.5 * np.linalg.norm(
        np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]), axis=1
    )
    tolerances = Tolerances.of(mesh)
    both = []
    for quick in (False, True):
        known = KnownSurfaces.of(mesh)
        if not quick:
            known.__dict__["prepared_surfaces"] = known.core_surfaces
        fit = deviation(mesh, area, known)
        both.append(
            (fit, surface_deviation(known, fit, tolerances), off_surface(known, tolerances))
        )
        assert (known.prepared_surfaces[0] is known.core_surfaces[0]) is not quick
    for one, other in zip(*both):
        for field, a, b in zip(one._fields, one, other):
            np.testing.assert_allclose(b, a, rtol=1e-12, atol=1e-13, err_msg=field)
