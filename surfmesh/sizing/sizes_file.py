"""Sizes by selection in a TOML file.

    [sizes."*"]
    chord = 0.05
    [sizes."fillet*"]
    chord = 0.01
    [[sizes."*".sources]]
    near = [[0, 0, 0], [1, 0, 0]]     # points, or lines = [[[0, 0, 0], [1, 0, 0]]],
    size = 0.1                        # ball = [x, y, z] with radius, box = [[...], [...]]
"""

from __future__ import annotations

import tomllib
from pathlib import Path
from typing import Any

from surfmesh.errors import FileFormatError, SizingError
from surfmesh.sizing.sizing import Sizing
from surfmesh.sizing.sources import InBall, InBox, Near, Source


def read_sizes(path: str | Path) -> dict[str, Sizing]:
    """The mapping of selections of a file, for ``mesh``.

    Raises ``FileFormatError`` for what is no TOML, ``SizingError`` for what is no size.
    """
    try:
        content = tomllib.loads(Path(path).read_text(encoding="utf-8"))
    except (tomllib.TOMLDecodeError, UnicodeDecodeError) as error:
        raise FileFormatError(f"{path}: {error}") from None
    unknown = sorted(set(content) - {"sizes"})
    if unknown or not isinstance(content.get("sizes"), dict):
        named = f"an unknown table [{unknown[0]}]" if unknown else "no table of sizes"
        raise FileFormatError(f"{path}: {named}; write sizes as [sizes.\"SELECTION\"]")
    found = {}
    for key, value in content["sizes"].items():
        try:
            found[key] = _sizing(value)
        except SizingError as error:
            raise SizingError(f"{path}, sizes of {key!r}: {error}") from None
    return found


def _sizing(value: Any) -> Sizing:
    if isinstance(value, dict) and "sources" in value:
        given = value["sources"]
        if not isinstance(given, list) or not all(isinstance(entry, dict) for entry in given):
            raise SizingError("sources are tables: [[sizes.\"SELECTION\".sources]]")
        value = value | {"sources": tuple(_source(dict(entry)) for entry in given)}
    return Sizing.of(value)


def _source(entry: dict[str, Any]) -> Source:
    kinds = [name for name in ("near", "lines", "ball", "box") if name in entry]
    if len(kinds) != 1:
        raise SizingError("a source has one of near, lines, ball, box")
    place = entry.pop(kinds[0])
    try:
        if kinds[0] == "near":
            return Near(place, **entry)
        if kinds[0] == "lines":
            return Near([_line(line) for line in place], **entry)
        if kinds[0] == "ball":
            return InBall(place, **entry)
        return InBox(*place, **entry)
    except TypeError as error:
        reason = str(error).partition(" ")[2]
        raise SizingError(f"source {kinds[0]!r}: {reason}") from None


def _line(given: Any) -> Any:
    import numpy as np

    return np.array(given, float)
