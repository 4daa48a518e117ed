"""The entries of a TOML file, with errors that name the file and the key."""

from __future__ import annotations

import re
import tomllib
from collections.abc import Collection, Mapping
from pathlib import Path
from typing import Any

from surfmesh.errors import SurfaceError, SurfmeshError
from surfmesh.geometry.text_file import text_of

DEEPEST = 12
"""Tables and lists within each other, and parts of a key: sizes by sources need eight."""

MOST_ENTRIES, MOST_VALUES = 100_000, 2_000_000
"""Keys and tables, and values, lists and lines: what takes tomllib ten seconds and a gigabyte."""

LARGEST = 2**63
"""Whole numbers of TOML have 64 bits."""

_LONG_KEY = re.compile(
    r"""(?<![\w"'.-])(?:(?:[\w-]++|"[^"\n]*+"|'[^'\n]*+')[ \t]*+\.[ \t]*+)""" + f"{{{DEEPEST}}}"
)

_TYPE_NAMES = {
    str: "text",
    int: "a whole number",
    float: "a number",
    bool: "true or false",
    list: "a list",
    dict: "a table",
}


def sets_key(path: Path, key: str) -> bool:
    """Does the file set this key at its top level? A look at the lines, no parsing.

    A file that cannot be read sets none.
    """
    try:
        text = text_of(path, SurfaceError, "a TOML file")
    except SurfaceError:
        return False
    return re.search(rf"^{key}\s*=", text, re.MULTILINE) is not None


def toml_content(path: Path, error: type[SurfmeshError]) -> dict[str, Any]:
    """What a TOML file holds; its numbers are finite to count with, but for inf and nan.

    Raises ``error`` that names the file for what cannot be read or is no TOML, for more than
    DEEPEST tables and lists within each other, and for whole numbers of more than 64 bits.
    """
    text = text_of(path, error, "a TOML file")
    _require_moderate(text, path, error)
    if found := _LONG_KEY.search(text):  # tomllib takes time with the square of the parts
        line = text.count("\n", 0, found.start()) + 1
        raise error(f"{path}: not a TOML file: a key of more than {DEEPEST} parts (at line {line})")
    try:
        content = tomllib.loads(text)
    except RecursionError:
        raise error(f"{path}: lists or tables are nested more than {DEEPEST} deep") from None
    except ValueError as reason:  # a TOMLDecodeError, or a whole number of thousands of digits
        raise error(f"{path}: not a TOML file: {_brief(reason)}") from None
    _look_through(content, path, error)
    return content


def _require_moderate(text: str, path: Path, error: type[SurfmeshError]) -> None:
    entries = text.count("=") + text.count("\n[")
    values = sum(map(text.count, ",[\n\\"))
    for count, most, what in (
        (entries, MOST_ENTRIES, "keys and tables"), (values, MOST_VALUES, "values and lines"),
    ):  # fmt: skip
        if count > most:
            raise error(
                f"{path}: holds {count:,} {what}, more than {most:,}; give so many numbers as "
                "arrays, from Python"
            )


def _look_through(content: dict[str, Any], path: Path, error: type[SurfmeshError]) -> None:
    """Level by level, so that no depth exhausts the stack."""
    level: list[tuple[str, Any]] = list(content.items())
    for _ in range(DEEPEST):
        below: list[tuple[str, Any]] = []
        for key, value in level:
            if isinstance(value, dict):
                below += [(f"{key}.{name}", inner) for name, inner in value.items()]
            elif isinstance(value, list):
                below += [(key, inner) for inner in value]
            elif isinstance(value, int) and not -LARGEST <= value < LARGEST:
                raise error(
                    f"{path}: '{key}' is a whole number of {value.bit_length()} bits, where TOML "
                    "has 64; write a large number with a point, as 1.0e30"
                )
        if not below:
            return
        level = below
    raise error(f"{path}: lists or tables are nested more than {DEEPEST} deep")


def _brief(reason: ValueError) -> str:
    said = str(reason)
    if "integer string conversion" in said:
        return "a whole number of thousands of digits"
    return said


class TomlEntries:
    """The entries of one file. error: what is raised for anything missing, unknown or wrong.

    content: of one table of the file, where not all of it is meant.
    """

    def __init__(
        self, path: Path, error: type[SurfmeshError] = SurfaceError,
        content: dict[str, Any] | None = None,
    ) -> None:  # fmt: skip
        self.path, self.error = path, error
        self.content = toml_content(path, error) if content is None else content

    def value(self, key: str, types: tuple[type, ...], default: Any = None) -> Any:
        if key not in self.content:
            if default is not None:
                return default
            raise self.error(f"{self.path}: the key '{key}' is missing")
        return self.expect(key, self.content[key], types)

    def table(self, key: str, required: bool = False) -> dict[str, Any]:
        return self.value(key, (dict,), default=None if required else {})

    def expect(self, key: str, value: Any, types: tuple[type, ...]) -> Any:
        """The value, when it has one of the types; true and false are not numbers here."""
        if not isinstance(value, types) or (isinstance(value, bool) and bool not in types):
            wanted = " or ".join(_TYPE_NAMES[t] for t in types)
            raise self.error(f"{self.path}: '{key}' must be {wanted}, not {value!r:.60}")
        return value

    def refuse_unknown(self, table: Mapping[str, Any], known: Collection[str], prefix: str) -> None:
        for key in table:
            if key not in known:
                choices = ", ".join(sorted(known))
                raise self.error(f"{self.path}: unknown key '{prefix}{key:.60}'; known: {choices}")
