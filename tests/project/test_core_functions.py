"""The core has elementary functions of its own: a library's differ from machine to machine."""

import re
from pathlib import Path

import pytest

SOURCES = sorted((Path(__file__).parents[2] / "src").rglob("*.?pp"))
NAMES = (
    *("sin", "cos", "tan", "asin", "acos", "atan", "atan2", "sinh", "cosh", "tanh", "asinh"),
    *("acosh", "atanh", "exp", "exp2", "expm1", "log", "log2", "log10", "log1p", "pow", "cbrt"),
    *("hypot", "erf", "erfc", "tgamma", "lgamma", "beta", "fma", "sph_bessel"),
)
LIBRARY = re.compile(rf"\bstd::(?:{'|'.join(NAMES)})\b|\busing\s+(?:namespace\s+)?std\b")


@pytest.mark.parametrize("path", SOURCES, ids=lambda path: f"{path.parent.name}/{path.name}")
def test_nothing_of_the_mathematical_library_is_called(path):
    for number, line in enumerate(path.read_text(encoding="utf-8").splitlines(), 1):
        found = LIBRARY.search(line.split("//")[0])
        assert not found, f"line {number}: {found.group()}; use src/elementary_functions"
