"""The five examples of Wang, Ming and Lo (2007), with the figures of their Table 2."""

import runpy
from functools import cache
from pathlib import Path

import numpy as np
import pytest

import surfmesh as sm
from surfmesh.quality.measures.shape import alpha

NOTEBOOK = Path(__file__).parents[2] / "notebooks" / "paper_examples.py"

# nodes, Avg2 and Avg3 of raw meshes in the paper; Min3 wanted of our optimised ones
PAPER = {
    "letter_a": (2552, 1.757723, 0.878948, 0.45),
    "floor_plate": (8864, 1.395665, 0.921719, 0.45),
    "two_peaks": (8138, 1.145573, 0.946467, 0.6),
    "wavy": (40000, 1.105738, 0.951014, 0.6),
}
SIZINGS = {
    "two_peaks": sm.Sizing(chord=0.0039, growth=1.15),
    "wavy": sm.Sizing(chord=0.0385, growth=1.15),
}
smooth_ones = pytest.mark.parametrize("name", PAPER)


@cache
def meshed(name, optimise):
    return sm.mesh(sm.load(name), SIZINGS.get(name), optimise=optimise)


def test_random_size():
    found = [
        sm.pack(sm.UniformRadius(1, 1000, seed=seed), count=1000).statistics for seed in range(10)
    ]
    elements = np.mean([one.elements for one in found])
    assert elements == pytest.approx(1898, rel=0.03)
    assert np.mean([one.size_error_mean for one in found]) <= 0.151276
    assert np.mean([one.alpha_mean for one in found]) >= 0.823691


def test_random_size_ratio_of_neighbours():
    """Avg2 says how radii were drawn more than how they were packed: it varies from 3.8 to 7.8
    over seeds, so the paper's 4.22, of one packing, must lie among them."""
    found = [
        sm.pack(sm.UniformRadius(1, 1000, seed=seed), count=1000).statistics.neighbour_ratio_mean
        for seed in range(10)
    ]
    assert min(found) < 4.222539 < max(found)


@smooth_ones
def test_as_many_nodes_as_the_paper(name):
    mesh = meshed(name, False)
    assert len(mesh.points) == pytest.approx(PAPER[name][0], rel=0.1)


@smooth_ones
def test_raw_averages_are_no_worse_than_the_papers(name):
    _, ratio_there, shape_there, _ = PAPER[name]
    mesh = meshed(name, False)
    a, b = mesh.sizes[mesh.edges].T
    assert np.maximum(a / b, b / a).mean() <= ratio_there
    assert alpha(mesh).mean() >= shape_there


@smooth_ones
def test_optimised_shapes(name):
    mesh = meshed(name, True)
    assert mesh.broken_invariant() is None
    assert alpha(mesh).mean() >= 0.97
    assert alpha(mesh).min() >= PAPER[name][3]


def test_the_document_makes_its_pictures(tmp_path, capsys):
    runpy.run_path(str(NOTEBOOK))["main"](tmp_path)
    said = capsys.readouterr().out
    for name in ("random_size", *PAPER):
        assert (tmp_path / f"paper_{name}.png").stat().st_size > 5000
        assert name.replace("_", " ") in said.replace("_", " ")
    assert said.count("optimised") == len(PAPER)
