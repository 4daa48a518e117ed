"""Surfaces as TOML files, and the gallery of them.

name = "torus"                      x, y, z: formulas in u, v and the parameters
description = "one line"            [domain] numbers or text such as "2*pi"
x = "(R + r*cos(v)) * cos(u)"       loops: polygons in (u, v) that trim the surface
y = "(R + r*cos(v)) * sin(u)"       [sizing] defaults for meshing this surface
z = "r*sin(v)"                      [facts] what is known: area, volume, euler, closed,
[parameters]                            one_sided, embedded (false: it crosses itself);
R = 3.0                                 gaussian and mean are formulas in u, v, for the
r = 1.0                                 normal along r_u x r_v
[domain]
u = [0, "2*pi"]
v = [0, "2*pi"]
"""

from __future__ import annotations

import sysconfig
from collections.abc import Mapping
from functools import cache
from pathlib import Path
from typing import Any

from surfmesh.errors import FormulaError, SurfaceError
from surfmesh.geometry.files.toml_entries import TomlEntries, sets_key
from surfmesh.geometry.formulas.compiled_ahead import CompiledFormulas, compiled_ahead, key_of
from surfmesh.geometry.formulas.parametric import ParametricSurface

KEYS = {"name", "description", "x", "y", "z", "parameters", "domain", "loops", "sizing", "facts"}
SIZING_KEYS = {"chord", "angle", "size", "min_size", "max_size", "growth", "anisotropy"}
FACT_KEYS = {
    "area": (int, float),
    "volume": (int, float),
    "euler": (int,),
    "closed": (bool,),
    "one_sided": (bool,),
    "embedded": (bool,),
    "gaussian": (str, int, float),
    "mean": (str, int, float),
}


def load_formula_file(path: str | Path, ahead: bool = True) -> ParametricSurface:
    """The surface of a TOML formula file; ahead: what the gallery has of it is not compiled anew.

    Raises SurfaceError that names the file and the key for anything missing, unknown or of the
    wrong type, FormulaError with the column for a formula that is refused.
    """
    return formula_surface(TomlEntries(Path(path)), ahead)


def formula_surface(entries: TomlEntries, ahead: bool = True) -> ParametricSurface:
    """The surface of the entries of a file, or of a table in one; raises as above."""
    path = entries.path
    entries.refuse_unknown(entries.content, KEYS, "")
    domain = entries.table("domain", required=True)
    entries.refuse_unknown(domain, {"u", "v"}, "domain.")
    sizing = entries.table("sizing")
    entries.refuse_unknown(sizing, SIZING_KEYS, "sizing.")
    facts = entries.table("facts")
    entries.refuse_unknown(facts, FACT_KEYS, "facts.")
    for key, value in sizing.items():
        entries.expect(f"sizing.{key}", value, (int, float))
    for key, value in facts.items():
        entries.expect(f"facts.{key}", value, FACT_KEYS[key])
    x, y, z = (entries.value(axis, (str, int, float)) for axis in "xyz")
    u, v = (_pair(entries, domain, variable) for variable in "uv")
    key = key_of((x, y, z), (u, v), entries.table("parameters"))
    try:
        return ParametricSurface(
            x,
            y,
            z,
            u,
            v,
            parameters=entries.table("parameters"),
            loops=_loops(entries),
            name=entries.value("name", (str,)),
            description=entries.value("description", (str,), default=""),
            sizing_defaults=sizing,
            facts=facts,
            compiled=_of_gallery(key) if ahead else None,
        )
    except FormulaError as error:
        raise FormulaError(f"{path}: {error.reason}", error.text, error.column) from None
    except SurfaceError as error:
        raise SurfaceError(f"{path}: {error}") from None


def _of_gallery(key: str) -> CompiledFormulas | None:
    try:
        return compiled_ahead(gallery_folder(), key)
    except SurfaceError:  # there is no gallery
        return None


def key_of_file(path: Path) -> str:
    """What its formulas are looked up by among those that are compiled ahead."""
    entries = TomlEntries(path)
    domain = entries.table("domain", required=True)
    bounds = [_pair(entries, domain, variable) for variable in "uv"]
    formulas = [entries.value(axis, (str, int, float)) for axis in "xyz"]
    return key_of(formulas, bounds, entries.table("parameters"))


@cache
def gallery_folder() -> Path:
    """The folder of ready-made surfaces: in the source tree, else where the wheel put it.

    Raises SurfaceError when neither is there.
    """
    folders = (
        Path(__file__).resolve().parents[3] / "surfaces",
        Path(sysconfig.get_path("data")) / "share" / "surfmesh" / "surfaces",
    )
    for folder in folders:
        if (folder / "plane.toml").is_file():
            return folder
    looked = " nor ".join(map(str, folders))
    raise SurfaceError(f"the gallery of surfaces is neither in {looked}; reinstall surfmesh")


def gallery() -> dict[str, Path]:
    """Name -> formula file of every curved surface in the gallery, in alphabetical order.

    With the planar domains: ``surface_file.gallery``.
    """
    files = sorted(gallery_folder().glob("*.toml"))
    return {path.stem: path for path in files if not sets_key(path, "outer")}


def _pair(entries: TomlEntries, domain: Mapping[str, Any], variable: str) -> tuple[Any, Any]:
    key = f"domain.{variable}"
    if variable not in domain:
        raise SurfaceError(f"{entries.path}: the key '{key}' is missing")
    bounds = entries.expect(key, domain[variable], (list,))
    if len(bounds) != 2:
        raise SurfaceError(f"{entries.path}: '{key}' is a pair [first, last], not {bounds!r}")
    return tuple(entries.expect(key, bound, (int, float, str)) for bound in bounds)


def _loops(entries: TomlEntries) -> list[list[tuple[float, float]]]:
    given = entries.value("loops", (list,), default=[])
    if not given:
        return []
    from surfmesh.geometry.formulas.expression import parse_number

    loops = []
    for number, loop in enumerate(given):
        key = f"loops[{number}]"
        points = []
        for point in entries.expect(key, loop, (list,)):
            if not isinstance(point, list) or len(point) != 2:
                raise SurfaceError(f"{entries.path}: '{key}' holds {point!r}, not a pair [u, v]")
            for number_or_text in point:
                entries.expect(key, number_or_text, (int, float, str))
            try:
                points.append((parse_number(point[0]), parse_number(point[1])))
            except FormulaError as error:
                reason = f"{entries.path}: '{key}': {error.reason}"
                raise FormulaError(reason, error.text, error.column) from None
        loops.append(points)
    return loops
