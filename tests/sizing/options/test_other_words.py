"""Words of other programs lead to the options that they mean."""

from dataclasses import fields

import pytest

from surfmesh.errors import SizingError
from surfmesh.sizing.options.other_words import OTHER_WORDS, own_word
from surfmesh.sizing.options.sizing import Sizing


def test_they_lead_to_options():
    known = {option.name for option in fields(Sizing)}
    assert set(OTHER_WORDS.values()) <= known
    assert not OTHER_WORDS.keys() & known


@pytest.mark.parametrize(
    "word", ["hausd", "sag", "linear deflection", "Linear-Deflection", "faceting_tolerance"]
)
def test_chord_has_many_names(word):
    assert own_word(word) == "chord"
    with pytest.raises(SizingError, match="'chord'"):
        Sizing.of({word: 0.1})
    with pytest.raises(SizingError, match="'chord'"):
        Sizing(**{word: 0.1})


def test_names_are_needed():
    with pytest.raises(SizingError, match=r"Sizing\(size=0.1\)"):
        Sizing(0.1)
    with pytest.raises(SizingError, match="did you mean 'anisotropy'"):
        Sizing(anisotrpy=2)


def test_an_unknown_word():
    assert own_word("colour") is None
    with pytest.raises(SizingError, match="known are"):
        Sizing.of({"colour": 1})
