"""Surfaces that meet, as a TOML file.

name = "pipes"                       intersect: tables of this file, each like a formula file
description = "one line"             without [sizing], or other files beside it ("wavy.toml")
intersect = ["main", "branch"]       keep: a word, or a table of sides by name
[keep]
main = "+branch"
[main]
x = "cos(u)"
...
"""

from __future__ import annotations

from pathlib import Path
from typing import Any

from surfmesh.cad.model.cad_model import CadModel
from surfmesh.errors import SurfaceError
from surfmesh.geometry.files.formula_file import formula_surface, gallery_folder
from surfmesh.geometry.files.surface_file import load_surface_file
from surfmesh.geometry.files.toml_entries import TomlEntries
from surfmesh.geometry.surface import Surface
from surfmesh.intersection.intersect import intersected


def load_meeting_file(path: str | Path) -> CadModel:
    """The model of the surfaces in a file that cut each other.

    Raises ``SurfaceError`` that names the file for what is missing or unknown in it, and for
    surfaces that cannot be intersected.
    """
    path = Path(path)
    entries = TomlEntries(path)
    names = entries.value("intersect", (list,))
    known = {"name", "description", "intersect", "keep", "coincident", *map(str, names)}
    entries.refuse_unknown(entries.content, known, "")
    surfaces = [_surface(entries, name) for name in names]
    keep = entries.value("keep", (str, dict), default="all")
    coincident = entries.value("coincident", (str,), default="refuse")
    name = entries.value("name", (str,), default=path.stem)
    try:
        return intersected(surfaces, keep, name, coincident)
    except SurfaceError as error:
        raise SurfaceError(f"{path}: {error}") from None


def meeting_gallery() -> dict[str, Path]:
    """Name -> file of the ready-made surfaces that meet, in alphabetical order."""
    return {path.stem: path for path in sorted((gallery_folder() / "meeting").glob("*.toml"))}


def _surface(entries: TomlEntries, name: Any) -> Surface:
    entries.expect("intersect", name, (str,))
    if name in entries.content:
        table = dict(entries.table(name))
        table.setdefault("name", name)
        return formula_surface(TomlEntries(entries.path, content=table))
    beside = entries.path.parent / name
    if not beside.is_file():
        raise SurfaceError(f"{entries.path}: '{name}' is neither a table there nor a file beside")
    return load_surface_file(beside)
