"""Sizes by selection: every option either holds for the whole model or is combined."""

from dataclasses import fields

import pytest

from surfmesh.sizing.options.model_sizing import EVERYTHING, OF_THE_MODEL, combined
from surfmesh.sizing.options.sizing import Sizing
from surfmesh.sizing.options.sources import InBall

VALUES = {
    "chord": 0.1, "angle": 20.0, "size": 0.3, "min_size": 0.1, "max_size": 2.0, "gap": 3.0,
    "sources": (InBall((0, 0, 0), 1, 0.2),),
}  # fmt: skip


@pytest.mark.parametrize("name", sorted({item.name for item in fields(Sizing)} - set(OF_THE_MODEL)))
def test_no_option_of_a_selection_is_dropped(name):
    given = [(EVERYTHING, Sizing()), ("some", Sizing(**{name: VALUES[name]}))]
    assert getattr(combined(given), name) == VALUES[name]
