"""No point of a surface is farther from a triangle than what is proved of it."""

from itertools import pairwise

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

import surfmesh as sm
from surfmesh._core import proof, surfaces

SIDE = 16
WEIGHTS = np.array(
    [(i, j, SIDE - i - j) for i in range(SIDE + 1) for j in range(SIDE + 1 - i)]
) / float(SIDE)

SLOPE = 26
CELL_HEIGHT = 27  # a column of the bounds; the last is that of whole cells

X, Y, Z = np.eye(3)
TURNED = np.linalg.qr(np.array([[1.0, 2.0, 0.3], [-0.4, 1.0, 0.7], [0.2, -0.5, 1.5]]))[0]
BOX = ((-3.0, 3.0), (-3.0, 3.0))
rng = np.random.default_rng(5)


def spline(degrees, inner, weights, seed=0, domain=((0.0, 1.0), (0.0, 1.0))):
    """inner: knots inside, of both; or of each."""
    draw = np.random.default_rng(seed)
    inner = inner if isinstance(inner, tuple) else (inner, inner)
    knots = [
        np.concatenate([[0.0] * (p + 1), own, [1.0] * (p + 1)]) for p, own in zip(degrees, inner)
    ]
    shape = [len(k) - p - 1 for k, p in zip(knots, degrees)]
    grid = np.stack(np.meshgrid(*(np.linspace(0, 2, n) for n in shape), indexing="ij"), axis=-1)
    control = np.concatenate([grid, draw.normal(0, 0.3, (*shape, 1))], axis=2)
    w = draw.uniform(0.5, 2.0, shape) if weights else None
    return surfaces.spline_surface(domain, *knots, control, w, (0.0, 0.0))


def periodic(seed=0):
    """A spline that goes on as it began, along u."""
    draw = np.random.default_rng(seed)
    control = draw.normal(0, 1, (4, 3, 3))[[2, 3, 0, 1, 2, 3, 0]] + [0, 0, 3]
    knots, other = np.arange(11) / 4 - 0.75, np.array([0, 0, 0, 1, 1, 1.0])
    return surfaces.spline_surface(
        ((0.5, 1.5), (0.0, 1.0)), knots, other, control, None, (1.0, 0.0)
    )


def formula(x, y, z):
    return sm.ParametricSurface(x, y, z, u=(-2, 2), v=(-2, 2)).core


ELLIPSE = surfaces.ellipse(np.array([1.0, 2.0, 0.0]), X, Z, 0.7, 0.4)
CURVE = surfaces.spline_curve(
    np.array([0, 0, 0, 0, 0.4, 1, 1, 1, 1.0]), rng.normal(0, 1, (5, 3)) + [3, 0, 0], None,
    None, 0.0,
)  # fmt: skip
ARCS = surfaces.spline_curve(  # three quarters of a circle, and a straight end
    np.array([0, 0, 0, 0.25, 0.25, 0.5, 0.5, 0.75, 0.75, 1, 1, 1]),
    np.array([[4, 0, 0], [4, 1, 0], [3, 1, 0], [2, 1, 0], [2, 0, 0], [2, -1, 0], [3, -1, 0],
              [4, -1, 0], [5, -2, 0.0]]),
    np.array([1, 0.5**0.5, 1, 0.5**0.5, 1, 0.5**0.5, 1, 0.9, 1]), None, 0.0,
)  # fmt: skip
UNIT = ((0.0, 1.0), (0.0, 1.0))

SURFACES = {
    "paraboloid": formula("u", "v", "u**2 - 0.3*v**2"),
    "waves": formula("u", "v", "sin(3*u)*cos(2*v) + 0.1*u*v"),
    "bell": formula("u", "v", "exp(-u**2 - 2*v**2)"),
    "products": formula(  # of what depends on u, on v, on both, and on nothing
        "cos(v)*(2 + sin(u)) + u*0.3",
        "sin(v/2)*(3 + v)*cosh(v/3)*cos(u/2)",
        "sin(u)*(4 + u)*exp(u/4)/(3 + v) + 2*u/(4 + u)",
    ),
    "functions": formula("u + tanh(v)/3", "v*sqrt(3 + u)", "log(3 + u*v/2) + atan(u)*asinh(v)"),
    "powers": formula("u**3", "v + (3 + u)**0.7", "erf(v) + cosh(u/2) - 1/(4 + u)"),
    "inverse functions": formula("asin(u/3)*4", "acos(v/3)*4", "atan2(v, u + 4) + atanh(u/4)"),
    "roots": formula("u*sqrt(7 + u*v)/3", "v*cbrt(5 + u)", "1/(5 + u + v) + sinh(u/2)/3"),
    "tangents": formula("tan(u/3)*2", "v + (3 + u)**(v/3)", "tanh(u*v) + acosh(4 + u) + cosh(v/2)"),
    "of two kinds": formula(
        "u", "max(v, v - 9)", "u*v*sign(u + 9) + min(u**2, u + 9)*abs(u + 9)/9"
    ),
    "plane": surfaces.plane(BOX, X, TURNED[0], TURNED[1]),
    "cylinder": surfaces.cylinder(BOX, X, *TURNED, 1.3),
    "cone": surfaces.cone(BOX, X, *TURNED, 4.0, 0.4),
    "sphere": surfaces.sphere(BOX, X, *TURNED, 2.0),
    "torus": surfaces.torus(BOX, X, *TURNED, 2.0, 0.6),
    "bicubic": spline((3, 3), [0.3, 0.55, 0.8], False),
    "rational": spline((3, 2), [0.4], True),
    "bilinear and quintic": spline((1, 5), [], True, 3),
    "creased": spline((2, 3), ([0.4, 0.4, 0.7], [0.5, 0.5, 0.5]), False, 4),
    "creased and rational": spline((3, 2), ([0.3, 0.3, 0.3], [0.4, 0.6, 0.6]), True, 5),
    "short spans": spline((3, 2), ([0.4, 0.4 + 1e-9], [0.5, 0.5 + 1e-7]), True, 6),
    "beyond its knots": spline((3, 2), [0.4], True, 7, ((-1e-3, 1.001), (-1e-3, 1.001))),
    "periodic": periodic(),
    "extruded arcs": surfaces.extrusion(UNIT, ARCS, Z),
    "turned arcs": surfaces.revolution(UNIT, ARCS, np.zeros(3), Y),
    "extrusion": surfaces.extrusion(UNIT, CURVE, Y),
    "revolution": surfaces.revolution(BOX, ELLIPSE, -3 * X, Y),
    "turned spline": surfaces.revolution(UNIT, CURVE, np.zeros(3), Z),
}

number = st.floats(0.0, 1.0)


def triangles(draw_size, seed, surface):
    """Corners in (u, v) of a few triangles of about one size, and in space."""
    draw = np.random.default_rng(seed)
    (u0, u1), (v0, v1) = surface.domain
    low, wide = np.array([u0, v0]), np.array([u1 - u0, v1 - v0])
    size = 10.0 ** (-3.0 * draw_size) / 2
    at = draw.uniform(0, 1 - size, (6, 1, 2)) + size * draw.uniform(0, 1, (6, 3, 2))
    uv = low + wide * at
    return uv, surface.evaluate(uv.reshape(-1, 2), 0)[0].reshape(-1, 3, 3)


def bounds_of(surface, corners, uv, depth=2, limit=0.0, bends=None):
    count = len(uv)
    return proof.triangle_bounds(
        surface,
        corners,
        uv,
        0 * uv if bends is None else bends,
        np.full(count, limit),
        np.zeros(count, np.uint8),
        depth,
    )


@pytest.mark.parametrize("name", SURFACES)
@settings(max_examples=40, deadline=None)
@given(size=number, seed=st.integers(0, 2**32 - 1), depth=st.integers(0, 3))
def test_no_sample_is_beyond_the_bounds(name, size, seed, depth):
    surface = SURFACES[name]
    uv, corners = triangles(size, seed, surface)
    found = bounds_of(surface, corners, uv, depth)
    at = np.einsum("qk,mkd->mqd", WEIGHTS, uv)
    points = surface.evaluate(at.reshape(-1, 2), 0)[0].reshape(len(uv), -1, 3)
    flat = np.einsum("qk,mkd->mqd", WEIGHTS, corners)
    rounding = 1e-13 * (1.0 + np.abs(points).max())  # of the samples themselves
    away = points - flat
    assert (np.linalg.norm(away, axis=2).max(axis=1) <= found[:, 8] + rounding).all()
    normal = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    area = np.linalg.norm(normal, axis=1)
    longest = np.linalg.norm(corners - np.roll(corners, 1, axis=1), axis=2).max(axis=1)
    good = area > 1e-3 * longest**2
    normal[good] /= area[good, None]
    height = np.abs(np.einsum("mqd,md->mq", away, normal)).max(axis=1)
    assert (height <= found[:, 0] + rounding)[good].all()
    for side in range(3):
        along = corners[:, (side + 1) % 3] - corners[:, side]
        inward = np.cross(normal, along)
        inward /= np.maximum(np.linalg.norm(inward, axis=1), 1e-300)[:, None]
        on_side = WEIGHTS[:, (side + 2) % 3] == 0.0
        across = np.abs(np.einsum("mqd,md->mq", away[:, on_side], inward)).max(axis=1)
        assert (across <= found[:, 1 + side] + rounding)[good].all()


def places_of(uv, bends, weights):
    """(m, q, 2) of pieces with bent sides, at barycentric weights (q, 3); their derivatives along
    sides 0 and 1."""
    ends = [(k, (k + 1) % 3) for k in range(3)]
    at = np.einsum("qk,mkd->mqd", weights, uv)
    along = [np.repeat((uv[:, j] - uv[:, i])[:, None], len(weights), axis=1) for i, j in ends[:2]]
    for k, (i, j) in enumerate(ends):
        at += 4 * np.einsum("q,md->mqd", weights[:, i] * weights[:, j], bends[:, k])
        for side in (0, 1):
            w = np.zeros(3)
            w[side], w[side + 1] = -1.0, 1.0
            rate = w[i] * weights[:, j] + weights[:, i] * w[j]
            along[side] = along[side] + 4 * np.einsum("q,md->mqd", rate, bends[:, k])
    return at, along


@pytest.mark.parametrize("name", [name for name in SURFACES if "of two" not in name][:9])
@settings(max_examples=30, deadline=None)
@given(size=st.floats(0.3, 1.0), seed=st.integers(0, 2**32 - 1), bent=st.floats(0.0, 0.12),
       limit=st.sampled_from([0.0, 1e-3, 1e9]))  # fmt: skip
def test_pieces_with_bent_sides_keep_to_their_bounds(name, size, seed, bent, limit):
    """Distance, and how fast it changes."""
    surface = SURFACES[name]
    uv, corners = triangles(size, seed, surface)
    longest = np.linalg.norm(uv - np.roll(uv, 1, axis=1), axis=2).min(axis=1)
    draw = np.random.default_rng(seed)
    bends = bent * longest[:, None, None] * draw.uniform(-1, 1, uv.shape)
    found = bounds_of(surface, corners, uv, 2, limit, bends)
    at, along = places_of(uv, bends, WEIGHTS)
    inside = (np.abs(at) <= 2.0).all(axis=(1, 2))  # of the domain
    r, r_u, r_v = surface.evaluate(at.reshape(-1, 2), 1)
    shape = (len(uv), -1, 3)
    away = r.reshape(shape) - np.einsum("qk,mkd->mqd", WEIGHTS, corners)
    rounding = 1e-13 * (1.0 + np.abs(r).max())
    assert (np.linalg.norm(away, axis=2).max(axis=1) <= found[:, 8] + rounding)[inside].all()
    sides = np.stack([corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 1]], axis=2)
    good = inside & (np.linalg.cond(sides) < 1e3)
    rates = np.stack([
        (r_u * step.reshape(-1, 2)[:, :1] + r_v * step.reshape(-1, 2)[:, 1:]).reshape(shape)
        for step in along
    ], axis=3) - sides[:, None]  # fmt: skip
    _, triangular = np.linalg.qr(sides[good])
    slope = np.linalg.norm(rates[good] @ np.linalg.inv(triangular)[:, None], ord=2, axis=(2, 3))
    assert (slope.max(axis=1) <= found[good, SLOPE] * (1 + 1e-9) + 1e-8).all()


@pytest.mark.parametrize("name", SURFACES)
@settings(max_examples=15, deadline=None)
@given(size=number, seed=st.integers(0, 2**32 - 1))
def test_no_cell_rises_farther_than_its_part(name, size, seed):
    surface = SURFACES[name]
    uv, corners = triangles(size, seed, surface)
    height, whole = bounds_of(surface, corners, uv)[:, CELL_HEIGHT:].T / SIDE**2
    rounding = 1e-13 * (1.0 + np.abs(corners).max())
    normal = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    area = np.linalg.norm(normal, axis=1)
    longest = np.linalg.norm(corners - np.roll(corners, 1, axis=1), axis=2).max(axis=1)
    good = area > 1e-3 * longest**2
    normal[good] /= area[good, None]
    draw = np.random.default_rng(seed)
    for _ in range(4):  # a cell between points of the grid, and a point of it
        i, j = draw.integers(0, SIDE, 2)
        if i + j >= SIDE:
            i, j = SIDE - 1 - i, SIDE - 1 - j
        cell = np.array([(SIDE - i - j, i, j), (SIDE - 1 - i - j, i + 1, j),
                         (SIDE - 1 - i - j, i, j + 1)]) / SIDE  # fmt: skip
        inside = draw.dirichlet((1.0, 1.0, 1.0))
        places = np.einsum("ck,mkd->mcd", np.vstack([cell, inside @ cell]), uv)
        r = surface.evaluate(places.reshape(-1, 2), 0)[0].reshape(len(uv), 4, 3)
        away = r[:, 3] - np.einsum("c,mcd->md", inside, r[:, :3])
        assert (np.linalg.norm(away, axis=1) <= whole + rounding).all()
        assert (np.abs(np.einsum("md,md->m", away, normal)) <= height + rounding)[good].all()


@pytest.mark.parametrize("name", SURFACES)
def test_bounds_of_few_triangles_together_are_those_of_each_alone(name):
    """Derivatives over a cell of all say little of each: it is cut, though there is but one."""
    surface = SURFACES[name]
    uv, corners = triangles(0.7, 11, surface)
    together = bounds_of(surface, corners, uv)[:, 8]
    alone = [bounds_of(surface, corners[k : k + 1], uv[k : k + 1])[0, 8] for k in range(len(uv))]
    assert (together <= 1.05 * np.array(alone) + 1e-15).all()


@pytest.mark.parametrize("name", SURFACES)
def test_bounds_of_small_triangles_are_tight(name):
    surface = SURFACES[name]
    uv, corners = triangles(0.7, 11, surface)
    found = bounds_of(surface, corners, uv, 3)
    at = np.einsum("qk,mkd->mqd", WEIGHTS, uv)
    points = surface.evaluate(at.reshape(-1, 2), 0)[0].reshape(len(uv), -1, 3)
    flat = np.einsum("qk,mkd->mqd", WEIGHTS, corners)
    away = np.linalg.norm(points - flat, axis=2).max(axis=1)
    assert (found[:, 8] <= 2.0 * away + 1e-12).all()
    assert (found[:, 8] >= away - 1e-13).all()


def test_each_cut_makes_bounds_no_worse():
    surface = SURFACES["bicubic"]
    uv, corners = triangles(0.0, 2, surface)
    whole = [bounds_of(surface, corners, uv, depth)[:, 8] for depth in range(4)]
    assert all((b <= a * (1 + 1e-12)).all() for a, b in pairwise(whole))
    assert (whole[-1] < 0.9 * whole[0]).any()


def test_triangles_within_their_limit_are_not_cut():
    surface = SURFACES["bicubic"]
    uv, corners = triangles(0.0, 2, surface)
    assert (bounds_of(surface, corners, uv, 3, np.inf) == bounds_of(surface, corners, uv, 0)).all()


def test_a_corner_off_the_surface_is_said():
    surface = SURFACES["sphere"]
    uv, corners = triangles(0.5, 3, surface)
    corners[0, 1] += [0.0, 0.003, 0.004]
    found = bounds_of(surface, corners, uv)[:, 9]
    assert found[0] == pytest.approx(0.005, rel=1e-6) and (found[1:] < 1e-13).all()


def test_a_kink_within_a_triangle_has_no_bound():
    surface = formula("u", "v", "abs(u - 0.1)")
    uv = np.array([[(0, 0), (0.3, 0), (0, 0.3)], [(0.1, 0), (0.3, 0), (0.1, 0.3)]], float)
    corners = surface.evaluate(uv.reshape(-1, 2), 0)[0].reshape(-1, 3, 3)
    found = bounds_of(surface, corners, uv)[:, 8]
    assert np.isinf(found[0]) and found[1] < 1e-12


def ridge(knots):
    """A roof over the square, as a spline of the second degree along u with these knots."""
    control = np.zeros((len(knots) - 3, 2, 3))
    control[..., 0] = np.linspace(0, 1, len(control))[:, None]
    control[..., 1] = np.arange(2)
    control[len(control) // 2, :, 2] = 1.0
    return surfaces.spline_surface(UNIT, knots, np.array([0, 0, 1, 1.0]), control, None, (0.0, 0.0))


def test_a_crease_of_a_spline_within_a_triangle_counts_by_its_angle():
    surface = ridge(np.array([0, 0, 0, 0.5, 0.5, 1, 1, 1.0]))
    uv = np.array([[(0.4, 0), (0.6, 0), (0.4, 0.3)], [(0.5, 0), (0.7, 0), (0.5, 0.3)]], float)
    corners = surface.evaluate(uv.reshape(-1, 2), 0)[0].reshape(-1, 3, 3)
    found = bounds_of(surface, corners, uv)[:, 8]
    away = 1.0 - corners[0, 0, 2]  # of the top from the chord
    assert away < found[0] < 1.35 * away and found[1] < 0.2


def test_a_jump_of_a_spline_within_a_triangle_has_no_bound():
    surface = ridge(np.array([0, 0, 0, 0.5, 0.5, 0.5, 1, 1, 1.0]))
    uv = np.array([[(0.4, 0), (0.6, 0), (0.4, 0.3)]], float)
    corners = surface.evaluate(uv.reshape(-1, 2), 0)[0].reshape(-1, 3, 3)
    assert np.isinf(bounds_of(surface, corners, uv)[0, 8])


def test_a_spline_that_only_looks_creased_by_its_knots_is_bounded_as_a_smooth_one():
    """An arc of 180 degrees in two parts, whose weights are creased too, extruded."""
    surface = SURFACES["extruded arcs"]
    uv = np.array([[(0.249, 0), (0.251, 0), (0.25, 0.1)]], float)
    corners = surface.evaluate(uv.reshape(-1, 2), 0)[0].reshape(-1, 3, 3)
    at = np.einsum("qk,mkd->mqd", WEIGHTS, uv)
    flat = np.einsum("qk,mkd->mqd", WEIGHTS, corners)[0]
    away = np.linalg.norm(surface.evaluate(at[0], 0)[0] - flat, axis=1).max()
    assert away < bounds_of(surface, corners, uv)[0, 8] < 1.1 * away


def test_a_function_of_the_caller_has_no_bounds():
    surface = sm.NumericSurface(lambda u, v: (u, v, u * v), u=(0, 1), v=(0, 1))
    uv = np.array([[(0, 0), (1, 0), (0, 1)]], float)
    core = surfaces.CallbackSurface(surface)
    corners = core.evaluate(uv[0], 0)
    assert bounds_of(core, corners, uv) is None


def test_smooth_formulas_are_bounded_to_the_second_order():
    """Corners and fourth derivatives: what is given away falls with the square of the size."""
    surface = SURFACES["waves"]
    ratios = []
    for size in (0.5, 0.75, 1.0):
        uv, corners = triangles(size, 7, surface)
        at = np.einsum("qk,mkd->mqd", WEIGHTS, uv)
        points = surface.evaluate(at.reshape(-1, 2), 0)[0].reshape(len(uv), -1, 3)
        flat = np.einsum("qk,mkd->mqd", WEIGHTS, corners)
        away = np.linalg.norm(points - flat, axis=2).max(axis=1)
        ratios.append(np.median(bounds_of(surface, corners, uv)[:, 8] / away))
    assert ratios[2] < ratios[1] < ratios[0] and ratios[2] < 1.03


def test_seams_are_where_parameters_of_neighbours_differ():
    uv = np.array([[(0, 0), (1, 0), (0, 1)], [(1, 0), (1, 1), (0, 1)]], float)
    twins = np.array([-1, 5, -1, -1, -1, 1], np.int32)
    assert len(proof.parted_half_edges(uv, twins)) == 0
    assert proof.parted_half_edges(uv + [[[0]], [[2]]], twins).tolist() == [1]
    with pytest.raises(ValueError, match="twins"):
        proof.parted_half_edges(uv, twins[:3])
    with pytest.raises(ValueError, match="out of range"):
        proof.parted_half_edges(uv, np.full(6, 6, np.int32))


def test_given_arrays_are_looked_at():
    surface = SURFACES["plane"]
    uv, corners = triangles(0.5, 3, surface)
    with pytest.raises(ValueError, match="limits"):
        proof.triangle_bounds(surface, corners, uv, 0 * uv, np.zeros(2), np.zeros(6, np.uint8), 1)
    with pytest.raises(ValueError, match="depth"):
        bounds_of(surface, corners, uv, 99)
    found = bounds_of(surface, corners, uv)
    vertices = np.arange(18, dtype=np.int32).reshape(-1, 3)
    with pytest.raises(ValueError, match="twins"):
        proof.ring_bounds(corners, vertices, np.full(18, 18, np.int32), found, np.zeros(6))
    with pytest.raises(ValueError, match="triangles"):
        proof.ring_bounds(corners, vertices + 1, np.full(18, -1, np.int32), found, np.zeros(6))
