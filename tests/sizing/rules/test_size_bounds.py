"""What the least of all rules is kept within: what is stated, and defaults."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from surfmesh._core import sizing as core
from surfmesh.sizing.options.sizing import Sizing
from surfmesh.sizing.rules.size_rules import SizeRules, asked_rules

DIAGONAL = 10.0


def law(points):
    return np.full(len(points), 0.3)


@pytest.mark.parametrize(
    "asked, smallest, largest, longest",
    [
        ({"chord": 0.01}, 1e-4, 1.0, 1.0),
        ({"chord": 0.01, "max_size": 3.0}, 1e-4, 3.0, 3.0),
        ({"chord": 0.01, "min_size": 2.0}, 2.0, 2.0, 2.0),
        ({"size": 0.3}, 1e-4, 0.3, 0.3),
        ({"size": 1e-5}, 1e-5, 1e-5, 1e-5),
        ({"size": 0.3, "max_size": 0.5}, 1e-4, 0.3, 0.3),
        ({"size": law}, 1e-4, np.inf, np.inf),
        ({"chord": 0.01, "anisotropy": 5.0}, 1e-4, 1.0, 10.0),
        ({"chord": 0.01, "anisotropy": 5.0, "max_size": 0.5}, 1e-4, 0.5, 0.5),
    ],
)
def test_bounds(asked, smallest, largest, longest):
    rules = SizeRules.of(Sizing(**asked), DIAGONAL)
    assert rules.clamp == pytest.approx((smallest, largest))
    assert rules.longest == pytest.approx(longest)


@given(
    st.dictionaries(st.sampled_from(["chord", "angle", "size"]), st.floats(1e-3, 90.0), min_size=1),
    st.floats(1e-6, 1e6),
)
def test_each_bound_has_its_words(asked, diagonal):
    """Those of the default hold where nothing is stated, and no others say so."""
    rules = SizeRules.of(Sizing(**asked), diagonal)
    floors = [bound for bound in rules.bounds if bound.is_floor]
    tops = [bound for bound in rules.bounds if not bound.is_floor]
    assert [bound.size for bound in floors] == [rules.clamp[0]]
    assert len(tops) == ("size" not in asked)
    assert all(bound.is_default for bound in rules.bounds)


def test_bounds_and_rules_that_ask_for_nothing_are_refused():
    stated = {"min_size": None, "max_size": None, "size": None}
    others = {"has_size": True, "is_anisotropic": False}
    for wrong in ({"min_size": 0.0}, {"size": float("nan")}, {"max_size": -1.0}):
        with pytest.raises(ValueError, match="positive"):
            core.StatedBounds(**stated | wrong, **others)
    with pytest.raises(ValueError, match="no rule"):
        core.AskedRules([], [], [], core.StatedBounds(**stated, **others))
    assert asked_rules(Sizing()) is None
