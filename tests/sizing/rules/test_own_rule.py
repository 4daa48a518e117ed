"""A rule more is one class in ``RULES``: the field follows it, and explain names it."""

from dataclasses import dataclass

import numpy as np
import pytest

import surfmesh as sm
from surfmesh.sizing.rules import size_rules
from surfmesh.sizing.rules.rule import PlaceRule


@dataclass(frozen=True)
class Downhill(PlaceRule):
    steep: float

    @classmethod
    def asked_for(cls, sizing, diagonal):
        yield cls(0.05)

    def __str__(self):
        return f"downhill {self.steep:g}"

    def sizes(self, points):
        return 0.1 + self.steep * np.abs(points[:, 2])


@pytest.mark.parametrize("ratio", [1.0, 5.0])
def test_a_rule_of_ones_own(monkeypatch, ratio):
    monkeypatch.setattr(size_rules, "RULES", (*size_rules.RULES, Downhill))
    found = sm.explain(sm.load("torus"), sm.Sizing(chord=0.1, anisotropy=ratio), (3, 0, 1))
    row = found.winner
    assert (row.key, row.rule) == ("*", "downhill 0.05")
    z = abs(found.point[2])
    assert row.size == found.target_size == pytest.approx(0.1 + 0.05 * z)
    assert found.size == pytest.approx(row.size, rel=0.03)


def test_a_rule_of_ones_own_is_not_for_the_core_alone(monkeypatch):
    sizing = sm.Sizing(chord=0.1)
    assert size_rules.asked_rules(sizing) is not None
    monkeypatch.setattr(size_rules, "RULES", (*size_rules.RULES, Downhill))
    assert size_rules.asked_rules(sizing) is None
