"""The law of sizes that depend on the direction: as the rules and limits of Python have them."""

import numpy as np
import pytest
from scipy.spatial import cKDTree

import surfmesh as sm
from surfmesh._core.sizing import limit_longer_sizes
from surfmesh.geometry.differential.fundamental_forms import curvatures
from surfmesh.geometry.differential.sides import find_sides
from surfmesh.sizing.field.field_builder import FieldBuilder
from surfmesh.sizing.field.size_law import FieldNodes, SizeLaw
from surfmesh.sizing.rules.direction_rates import direction_rates
from surfmesh.sizing.rules.rim_rule import Rims
from surfmesh.sizing.rules.size_limits import SizeLimits, along_lines

SIZING = sm.Sizing(chord=0.01, anisotropy=8.0)
ROUND = 1.5
"""Ratio of two sizes up to which their directions do not matter: no rates are looked for."""


def places(law, n=40):
    grid = np.stack(np.meshgrid(*(np.linspace(0.0, e, n) for e in law.chart.extent)), axis=-1)
    return grid.reshape(-1, 2)


def sizes_along(nodes, directions):
    """(n,) of the metric of nodes in unit tangents (n, 3)."""
    onward = np.einsum("ij,ij->i", nodes.along, directions)
    across = np.einsum("ij,ij->i", np.cross(nodes.normal, nodes.along), directions)
    return 1.0 / np.hypot(onward / nodes.long, across / nodes.size)


@pytest.mark.parametrize("name", ["two_peaks", "torus", "klein"])
def test_nodes_are_what_rules_allow_along_principal_directions(name):
    surface = sm.load(name)
    law = SizeLaw.of(surface, SIZING)
    xy = places(law)
    local, nodes = law.local(xy), law(xy)
    k = curvatures(local.forms)
    sizes = law.rules.principal(k.k1, k.k2)
    assert (nodes.size == sizes.min(axis=1)).all() and (nodes.long == sizes.max(axis=1)).all()
    for d, allowed in ((k.d1, sizes[:, 0]), (k.d2, sizes[:, 1])):
        tangent = d[:, :1] * local.ru + d[:, 1:] * local.rv
        np.testing.assert_allclose(sizes_along(nodes, tangent), allowed, rtol=1e-6)
    assert (nodes.curvature == np.stack([k.k1, k.k2], axis=1)).all()
    rates = direction_rates(surface, local.at.uv, sizes[:, 0] > sizes[:, 1], nodes.size)
    stretched = nodes.long > ROUND * nodes.size
    assert stretched.any()
    assert (nodes.direction_rates == np.where(stretched[:, None], rates, 0.0)).all()


def test_rims_hold_along_themselves():
    surface = sm.load("catenoid")
    law = SizeLaw.of(surface, SIZING, rims=Rims(surface, find_sides(surface)))
    xy = places(law)
    nodes, local = law(xy), law.local(xy)
    for rule in law.directed:
        rows, rim = rule.limits(local.at)
        own = type(nodes)(*(a[rows] if len(a) else a for a in nodes))
        assert (sizes_along(own, rim.tangent) <= rim.sizes * (1.0 + 1e-9)).all()
    assert law.directed and (nodes.long <= law.after(rims=0)(xy).long).all()


def test_limits_hold_in_their_directions_alone():
    surface = sm.load("torus")
    free = SizeLaw.of(surface, SIZING)
    xy = places(free)
    local, wide = free.local(xy), free(xy)
    way = local.ru / np.linalg.norm(local.ru, axis=1)[:, None]
    rows = np.arange(7, len(xy), 101)
    sizes = 0.3 * sizes_along(wide, way)[rows]
    limits = SizeLimits(
        local.at.points[rows], sizes, 0.2, metric_root_3d=along_lines(way[rows], sizes)
    )
    held = SizeLaw.of(surface, SIZING, limits)(xy[rows])
    assert (sizes_along(held, way[rows]) <= sizes * (1.0 + 1e-9)).all()
    assert (held.size <= wide.size[rows]).all() and (held.long <= wide.long[rows]).all()


def test_what_a_callers_function_raises_comes_through():
    def angry(points):
        raise RuntimeError("not today")

    law = SizeLaw.of(sm.load("torus"), sm.Sizing(size=angry, chord=0.1, anisotropy=4.0))
    with pytest.raises(RuntimeError, match="not today"):
        law(places(law))


@pytest.mark.parametrize("name", ["two_peaks", "wavy_sphere"])
def test_fields_are_graded_where_longer_sizes_were_limited(name):
    law = SizeLaw.of(sm.load(name), SIZING)
    builder = FieldBuilder(law)
    builder.background()
    nodes, xy = FieldNodes(*builder.core.nodes()), builder.core.plane()
    around = cKDTree(xy).query(xy, 4)[1]
    a, b = np.repeat(around[:, 0], 3), around[:, 1:].ravel()
    step = nodes.point[b] - nodes.point[a]
    length = np.linalg.norm(step, axis=1)
    way = step / np.maximum(length, 1e-300)[:, None]
    of = [sizes_along(FieldNodes(*(x[k] for x in nodes)), way) for k in (a, b)]
    allowed = of[0] + law.sizing.gradient * length
    assert np.quantile(of[1] / allowed, 0.99) < 1.02


def test_fields_that_are_not_refined_or_have_one_size_are_refused():
    surface = sm.load("torus")
    stretched = SizeLaw.of(surface, SIZING)
    builder = FieldBuilder(stretched)
    with pytest.raises(ValueError, match="not refined"):
        limit_longer_sizes(builder.core, stretched.in_core(), 0.01)
    isotropic = SizeLaw.of(surface, sm.Sizing(chord=0.1))
    builder = FieldBuilder(isotropic)
    builder.background()
    with pytest.raises(ValueError, match="direction"):
        limit_longer_sizes(builder.core, stretched.in_core(), 0.01)
