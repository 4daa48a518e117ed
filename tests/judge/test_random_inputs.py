"""A handful of random parts, domains and surfaces; ``benchmarks/random_inputs.py`` tries more."""

import numpy as np
import pytest

from judge.judged_meshes import domain_trial, part_trial, planar, surface_trial
from judge.random_domains import domain_of
from judge.random_surfaces import surface_of


@pytest.mark.parametrize("number", [3, 7])
def test_parts(number):
    trial = part_trial(0, number)
    assert trial.outcome == "good", trial


@pytest.mark.parametrize("number", [0, 1, 2, 3, 4, 5])
def test_domains(number):
    trial = domain_trial(0, number)
    assert trial.outcome in ("good", "found"), trial


@pytest.mark.parametrize("number", [4, 9, 27, 66])
def test_surfaces(number):
    trial = surface_trial(0, number)
    assert trial.outcome == "good", trial


def test_the_same_number_is_the_same_thing():
    assert domain_of(1, 7).polygon.equals(domain_of(1, 7).polygon)
    assert surface_of(1, 7)[1].formulas == surface_of(1, 7)[1].formulas
    assert planar(domain_of(1, 7)).domain == planar(domain_of(1, 7)).domain
    assert not np.array_equal(domain_of(1, 7).polygon.bounds, domain_of(2, 7).polygon.bounds)
