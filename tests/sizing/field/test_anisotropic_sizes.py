"""Two sizes along the principal directions: from curvature, in the field, at umbilics, graded."""

import numpy as np
import pytest
from naive.metric import metric_root_3d
from naive.searched_deviation import searched_deviation

from surfmesh.geometry.cad_surfaces.elementary import Cylinder
from surfmesh.geometry.differential.sides import find_sides
from surfmesh.geometry.formulas.parametric import ParametricSurface
from surfmesh.loading import load
from surfmesh.sizing.field.boundary_field import has_boundary_field
from surfmesh.sizing.field.size_field import size_field
from surfmesh.sizing.field.size_law import SizeLaw
from surfmesh.sizing.options.sizing import Sizing
from surfmesh.sizing.rules.curvature_size import (
    STRAIGHT_RESERVE,
    STRETCHED_RESERVE,
    chord_size,
    evened_chord_sizes,
    principal_chord_sizes,
    saddle_lattice_sizes,
)
from surfmesh.sizing.rules.direction_size import size_along
from surfmesh.sizing.rules.size_limits import SizeLimits, along_lines
from surfmesh.sizing.rules.size_rules import SizeRules


@pytest.mark.parametrize("k2", [1.0, 0.3, 1e-3, 1e-6, -1e-3, -0.3, -1.0])
@pytest.mark.parametrize("ratio", [3.0, 30.0])
def test_stretched_triangles_use_what_they_may_of_the_chord(k2, ratio):
    k1, chord = 1.0, 1e-6
    sizes = principal_chord_sizes(np.array([k1]), np.array([k2]), chord, ratio)
    h1, h2 = (float(h[0]) for h in sizes)
    h2 = min(h2, ratio * h1)
    used = searched_deviation(k1, k2, h1, h2) / chord
    assert 0.9 * STRETCHED_RESERVE < used < 1.05 * STRAIGHT_RESERVE


@pytest.mark.parametrize("k2", [1.0, 0.3, 1e-3, -1e-3, -0.3, -1.0])
def test_where_deviations_are_evened_out_more_of_the_chord_is_used(k2):
    k1, chord, ratio = 1.0, 1e-6, 30.0
    h1, h2 = (float(h[0]) for h in evened_chord_sizes(np.array([k1]), np.array([k2]), chord, ratio))
    used = searched_deviation(k1, k2, h1, min(h2, ratio * h1)) / chord
    assert 0.82 < used < 0.97  # all triangles may: a side of that length is within


def test_lattices_on_saddles_are_sized_for_edges_between_the_principal_directions():
    k1, k2, chord = 2.0, -0.5, 1e-6
    h1, h2 = (
        float(h[0]) for h in saddle_lattice_sizes(np.array([k1]), np.array([k2]), chord, 30.0)
    )
    turned = np.radians(15.0 + 60.0 * np.arange(3))
    edge = np.stack([h1 * np.cos(turned), h2 * np.sin(turned)], axis=1)
    sag = np.abs(edge**2 @ (k1, k2)) / 8.0
    assert np.isclose(sag.max(), 0.87 * chord) and sag.min() < 1e-12 * chord


def test_ratio_one_is_the_isotropic_rule():
    k1, k2 = np.random.default_rng(1).normal(size=(2, 50))
    shorter = np.minimum(*principal_chord_sizes(k1, k2, 1e-6, 1.0))
    factor = shorter / chord_size(k1, k2, 1e-6)
    assert np.ptp(factor) < 0.06  # reserves differ a little with the curvatures


def umbilic_of_ellipsoid(a, b, c):
    """x, z of an umbilic (do Carmo, 3-4, exercise 9), y = 0."""
    x = a * np.sqrt((a**2 - b**2) / (a**2 - c**2))
    return x, c * np.sqrt(1 - (x / a) ** 2)


def test_smooth_at_the_umbilics_of_an_ellipsoid():
    """Through an umbilic the tensor changes as much as the way is long, not by a jump."""
    a, b, c = 3.0, 2.0, 1.0
    surface = ParametricSurface(
        f"{a}*cos(u)*cos(v)", f"{b}*sin(u)*cos(v)", f"{c}*sin(v)", (-3, 3), (-1.5, 1.5)
    )
    law = SizeLaw.of(surface, Sizing(chord=1e-3, anisotropy=50.0), None)
    x, z = umbilic_of_ellipsoid(a, b, c)
    place = np.array([0.0, np.arcsin(z / c)])
    assert np.hypot(*surface.evaluate(place[None], 0)[0][0, [0, 2]] - (x, z)) < 1e-9
    angle = np.linspace(0, 2 * np.pi, 24, endpoint=False)
    around = np.stack([np.cos(angle), np.sin(angle)], axis=1)
    change = []
    for radius in (1e-2, 1e-3, 1e-4):
        xy = law.chart.to_plane(np.vstack([place, place + radius * around]))
        nodes = law(xy)
        less = (1.0 / nodes.size - 1.0 / nodes.long)[:, None, None]
        tangents = nodes.along[:, :, None] * nodes.along[:, None]
        w = (np.eye(3) / nodes.size[:, None, None] - less * tangents) * nodes.size[0]
        change.append(np.abs(w - w[0]).max())
    assert change[0] < 0.1
    np.testing.assert_allclose(change[1:], [change[0] / 10, change[0] / 100], rtol=0.3)


def lengths_in(field, xy, steps):
    """Metric lengths (n,) of small steps in the scaled plane, from the packing's tensors."""
    h = field.tensors(xy)
    det = h[:, 0] * h[:, 2] - h[:, 1] ** 2
    x = (h[:, 2] * steps[:, 0] - h[:, 1] * steps[:, 1]) / det
    y = (h[:, 0] * steps[:, 1] - h[:, 1] * steps[:, 0]) / det
    return np.hypot(x, y)


@pytest.mark.parametrize("name, ratio", [("ellipsoid", 10.0), ("torus", 3.0), ("helicoid", 10.0)])
def test_the_field_is_what_the_curvature_asks_for(name, ratio):
    """Where growth does not act: lengths in any direction, in the plane and in space."""
    surface = load(name)
    sizing = Sizing(chord=1e-3, anisotropy=ratio, growth=50.0)
    field = size_field(surface, sizing, find_sides(surface))
    bounds = SizeLaw.of(surface, sizing).rules
    rng = np.random.default_rng(2)
    xy = rng.uniform(0.1, 0.9, (4000, 2)) * field.chart.extent
    uv, rates = field.chart.to_uv_and_rates(xy)
    step = rng.normal(size=(4000, 2))
    _, ru, rv = surface.evaluate(uv, 1)
    d = step[:, :1] * rates[:, :1] * ru + step[:, 1:] * rates[:, 1:] * rv
    length = np.linalg.norm(d, axis=1)
    exact = length / size_along([surface], [uv], d / length[:, None], bounds)
    w = np.array([metric_root_3d(row) for row in field.metric_roots_3d(xy)])
    spatial = np.linalg.norm(np.einsum("nij,nj->ni", w, d), axis=1)
    for found in (lengths_in(field, xy, step), spatial):
        assert np.quantile(np.abs(found / exact - 1), 0.98) < 0.03


@pytest.mark.parametrize("ratio", [2.0, 40.0])
def test_the_ratio_is_bounded(ratio):
    surface = load("two_peaks")
    field = size_field(surface, Sizing(chord=1e-3, anisotropy=ratio), find_sides(surface))
    rng = np.random.default_rng(1)
    xy = rng.uniform(0, 1, (3000, 2)) * field.chart.extent
    w = np.array([metric_root_3d(row) for row in field.metric_roots_3d(xy)])
    values = np.linalg.eigvalsh(w)
    stretch = values[:, -1] / values[:, 0]
    assert stretch.max() <= ratio * (1 + 1e-9)
    assert stretch.max() > min(1.9, 0.5 * ratio)


def test_flat_places_are_round_and_sizes_clamped():
    bounds = SizeRules.of(Sizing(chord=1e-3, anisotropy=100.0, min_size=0.02, max_size=0.5), 10.0)
    k = np.array([0.0, 1e-12, 1e-3, 1.0, 1e6])
    sizes = bounds.principal(k, 0 * k)
    assert sizes.min() >= 0.02 and sizes.max() <= 0.5
    np.testing.assert_array_equal(sizes[0], sizes[0, ::-1])
    free = SizeRules.of(Sizing(chord=1e-3, anisotropy=100.0), 10.0)
    sizes = free.principal(np.geomspace(1e-9, 1.0, 2000), np.zeros(2000))
    assert (np.abs(np.diff(np.log(sizes), axis=0)) < 0.05).all()  # no jump on the way there
    assert sizes.max() <= 10.0


def test_a_size_law_holds_in_every_direction():
    surface = load("cylinder")
    sizing = Sizing(chord=1e-3, size=lambda p: np.full(len(p), 0.2), anisotropy=100.0)
    field = size_field(surface, sizing, find_sides(surface))
    xy = np.random.default_rng(1).uniform(0, 1, (500, 2)) * field.chart.extent
    w = np.array([metric_root_3d(row) for row in field.metric_roots_3d(xy)])
    assert (1 / np.linalg.eigvalsh(w)).max() <= 0.2 * (1 + 1e-9)


def test_limits_along_a_line_leave_sizes_across_it():
    e, points = np.array([[1.0, 0.0, 0.0]]), np.zeros((1, 3))
    limits = SizeLimits(
        points, np.array([0.1]), 0.2, metric_root_3d=along_lines(e, np.array([0.1]))
    )
    directions = np.array([[1.0, 0, 0], [0.6, 0.8, 0], [0, 1.0, 0]])
    found = limits.along(np.zeros((3, 3)), directions[None])[0]
    np.testing.assert_allclose(found[:2], [0.1, 0.1 / 0.6])
    assert found[2] > 1e9
    both = limits.joined_with(SizeLimits(points + 1, np.array([0.3]), 0.2))
    np.testing.assert_allclose(both.along(points + 1, directions[None, 2:]), [[0.3]])


def test_cylinders_are_not_grown_from_their_edges():
    x, y, z = np.eye(3)
    tube = Cylinder(domain=((0, 1), (0, 1)), origin=0 * x, x=x, y=y, z=z, radius=1.0)
    assert has_boundary_field(tube, Sizing(chord=1e-3))
    assert not has_boundary_field(tube, Sizing(chord=1e-3, anisotropy=2.0))


def test_no_more_is_feared_between_samples_than_with_round_sizes():
    """Enneper's surface: bounds by the isotropic rule made every cell suspect (800,000 cells)."""
    surface = load("enneper")
    fields = [
        size_field(surface, Sizing(chord=0.005, anisotropy=ratio), find_sides(surface))
        for ratio in (1.0, 5.0)
    ]
    cells = [len(field.background.child) for field in fields]
    assert cells[1] < 1.5 * cells[0]
