"""Sizes grow along the edges of a finished mesh by what ``growth`` allows."""

import pytest

import surfmesh as sm
from surfmesh.quality.measures.lengths import edge_figures


def growth_over_allowed(mesh):
    """The largest over all edges."""
    _, largest, _ = edge_figures(mesh, slope=mesh.sizing.gradient).changes
    return largest


@pytest.mark.parametrize(
    "name, growth",
    [("dini", 1.2), ("hyperbolic_paraboloid", 1.2), ("torus", 1.2), ("monkey_saddle", 1.1)],
)
def test_no_edge_grows_by_a_tenth_more_than_asked_where_sizes_are_stretched(name, growth):
    """4 to 11 % of them did, where the metric turns, and around sizes lowered for the chord; and
    a few where vertices had moved and edges were swapped at last."""
    mesh = sm.mesh(sm.load(name), sm.Sizing(anisotropy=8.0, growth=growth))
    assert growth_over_allowed(mesh) < 1.1
    assert sm.check(mesh).clean


@pytest.mark.parametrize("name", ["sphere", "monkey_saddle", "torus"])
def test_no_edge_grows_by_a_tenth_more_than_asked(name):
    """Up to 1.5 times: around sizes lowered for the chord, between neighbours of the last swaps."""
    assert growth_over_allowed(sm.mesh(sm.load(name))) < 1.1


def test_sizes_are_lowered_no_farther_than_edges_conform():
    """What is lowered last is no excuse for long edges: as many conform as before."""
    assert sm.check(sm.mesh(sm.load("monkey_saddle"))).quasi_unit_share > 0.99
