"""The law of a size field asked in the core: as the rules of Python have it."""

import numpy as np
import pytest

import surfmesh as sm
from surfmesh._core import allow_threads
from surfmesh.errors import SizingError
from surfmesh.geometry.differential.sides import find_sides
from surfmesh.sizing.field.size_law import SizeLaw
from surfmesh.sizing.rules.rim_rule import Rims
from surfmesh.sizing.rules.size_limits import SizeLimits

SIZINGS = {
    "chord": sm.Sizing(chord=0.01),
    "angle": sm.Sizing(angle=20.0),
    "both": sm.Sizing(chord=0.02, angle=15.0, max_size=0.3, min_size=0.02),
    "law": sm.Sizing(chord=0.02, size=lambda p: 0.1 + np.abs(p[:, 0])),
}


def places(law):
    grid = np.stack(np.meshgrid(*(np.linspace(0.0, e, 60) for e in law.chart.extent)), axis=-1)
    return grid.reshape(-1, 2)


@pytest.mark.parametrize("sizing", SIZINGS.values(), ids=SIZINGS)
@pytest.mark.parametrize("name", ["two_peaks", "torus", "sphere"])
def test_nodes_are_the_least_of_all_rules(name, sizing):
    surface = sm.load(name)
    law = SizeLaw.of(surface, sizing, rims=Rims(surface, find_sides(surface)))
    xy = places(law)
    local = law.local(xy)
    least = np.minimum.reduce([sizes for _, sizes in law.demands(local)])
    nodes = law(xy)
    assert (nodes.size == np.clip(least, *law.clamp)).all()
    assert (nodes.point == local.at.points).all() and (nodes.normal == local.forms.normal).all()


def test_limits_lower_sizes_and_not_what_was_asked_for():
    surface, sizing = sm.load("torus"), sm.Sizing(chord=0.1)
    uv = np.array([[1.0, 2.0]])
    point = surface.evaluate(uv, 0)[0]
    free = SizeLaw.of(surface, sizing)
    held = SizeLaw.of(surface, sizing, SizeLimits(point, np.array([1e-3]), 0.2, uv))
    xy = places(free)
    away = np.linalg.norm(free(xy).point - point, axis=1)
    assert (held(xy).size == np.minimum(free(xy).size, 1e-3 + 0.2 * away)).all()
    assert (held(xy).target_size == free(xy).size).all()


@pytest.mark.parametrize("anisotropy", [1.0, 8.0])
def test_any_number_of_threads_gives_the_same(anisotropy):
    surface = sm.load("two_peaks")
    sizing = sm.Sizing(chord=0.01, anisotropy=anisotropy)
    law = SizeLaw.of(surface, sizing, rims=Rims(surface, find_sides(surface)))
    xy = places(law)
    one = law(xy)
    before = allow_threads(4)
    try:
        four = law(xy)
    finally:
        allow_threads(before)
    assert all((a == b).all() for a, b in zip(one, four))


def test_what_a_callers_function_raises_comes_through():
    def angry(points):
        raise RuntimeError("not today")

    law = SizeLaw.of(sm.load("torus"), sm.Sizing(size=angry))
    with pytest.raises(RuntimeError, match="not today"):
        law(places(law))
    law = SizeLaw.of(sm.load("torus"), sm.Sizing(size=lambda points: -points[:, 0]))
    with pytest.raises(SizingError, match="positive"):
        law(places(law))
