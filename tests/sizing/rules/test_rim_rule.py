"""Free rims of formula surfaces are cut by their full curvature, within the surface too."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

import surfmesh as sm
from surfmesh._core.sizing import RIM_RESERVE
from surfmesh.geometry.differential.sides import find_sides
from surfmesh.sizing.rules.rim_rule import Rims, rim_sizes


def rim_sag(surface, mesh, samples=17):
    """Largest distance of the true rim from the free edges of the mesh, model units."""
    rows = np.flatnonzero(mesh.connectivity.half_edges[:, 1] < 0)
    triangle, corner = np.divmod(mesh.connectivity.half_edges[rows, 0], 3)
    ends = [mesh.uv[triangle, (corner + k) % 3] for k in (0, 1)]
    worst = 0.0
    a, b = (surface.evaluate(end, 0)[0] for end in ends)
    way = (b - a) / np.linalg.norm(b - a, axis=1)[:, None]
    for t in np.linspace(0.0, 1.0, samples):
        offset = surface.evaluate((1 - t) * ends[0] + t * ends[1], 0)[0] - a
        offset -= np.einsum("ij,ij->i", offset, way)[:, None] * way
        worst = max(worst, float(np.linalg.norm(offset, axis=1).max()))
    return worst


@pytest.mark.parametrize("name", ["monkey_saddle", "helicoid", "mobius", "catenoid", "enneper"])
def test_rims_of_the_gallery_lie_within_chord(name):
    surface = sm.load(name)
    chord = 3e-3
    mesh = sm.mesh(surface, sm.Sizing(chord=chord))
    assert rim_sag(surface, mesh) <= chord


@settings(max_examples=8)
@given(
    inner=st.floats(0.1, 0.9), turn=st.floats(0.5, 6.0), scale=st.sampled_from([1e-3, 1.0, 1e3]),
    height=st.floats(0.0, 1.0), ratio=st.sampled_from([1.0, 10.0]),
)  # fmt: skip
def test_sectors_of_rings_bend_within_the_surface_only(inner, turn, scale, height, ratio):
    surface = sm.ParametricSurface(
        f"{scale!r}*u*cos(v)", f"{scale!r}*u*sin(v)", f"{scale * height!r}*u",
        u=(inner, 1.0), v=(0.0, turn),
    )  # fmt: skip
    chord = 4e-3 * scale
    mesh = sm.mesh(surface, sm.Sizing(chord=chord, anisotropy=ratio))
    assert rim_sag(surface, mesh) <= chord
    assert len(mesh.triangles) < 2000


@pytest.mark.parametrize("ratio", [1.0, 10.0])
def test_loops_are_cut_by_their_curvature_in_space(ratio):
    square = [(0.5, 0.5), (2.5, 0.5), (2.5, 5.5), (0.5, 5.5)]
    surface = sm.ParametricSurface(
        "u*cos(v)", "u*sin(v)", "0.2*u**2", u=(0.2, 3), v=(0, 6.25), loops=[square]
    )
    chord = 6e-3
    mesh = sm.mesh(surface, sm.Sizing(chord=chord, anisotropy=ratio))
    assert rim_sag(surface, mesh) <= chord


def test_straight_rims_cost_nothing():
    surface = sm.ParametricSurface("u", "v", "u*v", u=(-1, 1), v=(-1, 1))
    at, onward = np.array([(0.3, 1.0)]), np.array([(1.0, 0.0)])
    assert not np.isfinite(rim_sizes(surface, at, onward, 1e-3).sizes)
    # a cylinder's rim bends as the surface does: it asks for no more than that
    tube = sm.ParametricSurface("cos(u)", "sin(u)", "v", u=(0, 3), v=(0, 1))
    size = rim_sizes(tube, at, onward, 1e-3).sizes
    assert np.allclose(size, np.sqrt(8 * RIM_RESERVE * 1e-3))


def test_min_size_is_kept_at_rims():
    surface = sm.ParametricSurface("u*cos(v)", "u*sin(v)", "0*u", u=(0.2, 1), v=(0, 3))
    mesh = sm.mesh(surface, sm.Sizing(chord=1e-5, min_size=0.1))
    edges = mesh.points[mesh.edges[mesh.connectivity.half_edges[:, 1] < 0]]
    assert np.linalg.norm(edges[:, 1] - edges[:, 0], axis=1).min() > 0.06


def test_joined_sides_are_no_rims():
    torus, tube = sm.load("torus"), sm.load("catenoid")
    assert not Rims(torus, find_sides(torus)).open
    assert len(Rims(tube, find_sides(tube)).open) == 2
