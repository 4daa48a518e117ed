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

from dataclasses import fields
from pathlib import Path
from typing import Any

from surfmesh.errors import FileFormatError, SizingError
from surfmesh.geometry.files.toml_entries import toml_content
from surfmesh.sizing.options.sizing import Sizing
from surfmesh.sizing.options.sources import InBall, InBox, Near, Source

_KINDS = {"near": ("radius",), "lines": ("radius",), "ball": ("radius",), "box": ()}
"""What a source may have beside its size, growth and reach."""


def read_sizes(path: str | Path) -> dict[str, Sizing]:
    """The mapping of selections of a file, for ``mesh``.

    Raises ``FileFormatError`` for what is no TOML, ``SizingError`` for what is no size.
    """
    content = toml_content(Path(path), FileFormatError)
    unknown = sorted(set(content) - {"sizes"})
    if unknown or not isinstance(content.get("sizes"), dict):
        named = f"an unknown table [{unknown[0]:.60}]" if unknown else "no table of sizes"
        raise FileFormatError(f'{path}: {named}; write sizes as [sizes."SELECTION"]')
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
            raise SizingError('sources are tables: [[sizes."SELECTION".sources]]')
        value = value | {"sources": tuple(_source(dict(entry)) for entry in given)}
    if isinstance(value, dict):
        known = {item.name for item in fields(Sizing)} - {"sources"}
        _require_numbers({name: entry for name, entry in value.items() if name in known})
    elif isinstance(value, bool):
        raise SizingError("sizes are a number or a table, not true or false")
    return Sizing.of(value)


def _source(entry: dict[str, Any]) -> Source:
    kinds = [name for name in _KINDS if name in entry]
    if len(kinds) != 1:
        raise SizingError("a source has one of near, lines, ball, box")
    kind = kinds[0]
    place = entry.pop(kind)
    known = ("size", "growth", "reach", *_KINDS[kind])
    needed = ("size", "radius") if kind == "ball" else ("size",)
    if unknown := sorted(set(entry) - set(known)):
        raise SizingError(
            f"source {kind!r}: unknown key {unknown[0]!r:.60}; known: {', '.join(known)}"
        )
    if missing := [name for name in needed if name not in entry]:
        raise SizingError(f"source {kind!r}: {missing[0]!r} is missing")
    _require_numbers(entry)
    if kind == "near":
        return Near(place, **entry)
    if kind == "lines":
        if not isinstance(place, list):
            raise SizingError(f"source 'lines': a list of lines is needed, not {place!r:.60}")
        return Near([_line(line) for line in place], **entry)
    if kind == "ball":
        return InBall(place, **entry)
    if not isinstance(place, list) or len(place) != 2:
        raise SizingError(f"source 'box': two corners are needed, not {place!r:.60}")
    return InBox(*place, **entry)


def _require_numbers(table: dict[str, Any]) -> None:
    """Text is no number, and neither is true."""
    for name, value in table.items():
        if name == "vertices":
            continue  # a word, which Sizing looks at
        flag = name in ("gap_faces", "proof", "fewest")
        if isinstance(value, bool) != flag or not isinstance(value, (int, float)):
            what = "true or false" if flag else "a number"
            raise SizingError(f"{name} must be {what}, not {value!r:.60}")


def _line(given: Any) -> Any:
    import numpy as np

    try:
        return np.array(given, float)
    except (TypeError, ValueError):  # text, dates, rows of several lengths
        raise SizingError(
            f"source 'lines': a line is a list of points, not {given!r:.60}"
        ) from None
