"""The table of other programs' words says what the error messages say."""

import re
from pathlib import Path

from surfmesh.sizing.options.other_words import OTHER_WORDS, own_word

PAGE = Path(__file__).resolve().parents[2] / "docs" / "which-option.md"


def test_every_word_of_the_table_is_answered_with_ours():
    rows = re.findall(r"^\| `(\w+)` \| (.*) \|$", PAGE.read_text(encoding="utf-8"), re.MULTILINE)
    assert {own for own, _ in rows} == set(OTHER_WORDS.values())
    for own, words in rows:
        for word in re.split(r",| and ", re.sub(r"\([^)]*\)", "", words)):
            assert own_word(word.strip()) == own, word
