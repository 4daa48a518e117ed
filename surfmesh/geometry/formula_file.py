"""Surfaces as TOML files, and the gallery of them.

name = "torus"                      x, y, z: formulas in u, v and the parameters
description = "one line"            [domain] numbers or text such as "2*pi"
x = "(R + r*cos(v)) * cos(u)"       loops: polygons in (u, v) that trim the surface
y = "(R + r*cos(v)) * sin(u)"       [sizing] defaults for meshing this surface
z = "r*sin(v)"                      [facts] what is known: area, volume, euler, closed,
[parameters]                            one_sided; gaussian and mean are formulas in u, v,
R = 3.0                                 for the normal along r_u x r_v
r = 1.0
[domain]
u = [0, "2*pi"]
v = [0, "2*pi"]
"""

from __future__ import annotations

import sysconfig
import tomllib
from collections.abc import Mapping
from pathlib import Path
from typing import Any

from surfmesh.errors import FormulaError, SurfaceError
from surfmesh.geometry.parametric import ParametricSurface

KEYS = {"name", "description", "x", "y", "z", "parameters", "domain", "loops", "sizing", "facts"}
SIZING_KEYS = {"chord", "angle", "size", "min_size", "max_size", "growth", "anisotropy"}
FACT_KEYS = {
    "area": (int, float),
    "volume": (int, float),
    "euler": (int,),
    "closed": (bool,),
    "one_sided": (bool,),
    "gaussian": (str, int, float),
    "mean": (str, int, float),
}


def load_formula_file(path: str | Path) -> ParametricSurface:
    """The surface of a TOML formula file.

    Raises SurfaceError that names the file and the key for anything missing, unknown or of the
    wrong type, FormulaError with the column for a formula that is refused.
    """
    path = Path(path)
    try:
        content = tomllib.loads(path.read_text(encoding="utf-8"))
    except FileNotFoundError:
        raise SurfaceError(f"{path}: no such file") from None
    except OSError as error:
        raise SurfaceError(f"{path}: cannot be read: {error.strerror}") from None
    except (tomllib.TOMLDecodeError, UnicodeDecodeError) as error:
        raise SurfaceError(f"{path}: not a TOML file: {error}") from None
    entries = _Entries(path, content)
    entries.refuse_unknown(content, KEYS, "")
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
    formulas = [entries.value(axis, (str, int, float)) for axis in "xyz"]
    bounds = [entries.pair(domain, variable) for variable in "uv"]
    try:
        return ParametricSurface(
            *formulas,
            *bounds,
            parameters=entries.table("parameters"),
            loops=entries.loops(),
            name=entries.value("name", (str,)),
            description=entries.value("description", (str,), default=""),
            sizing_defaults=sizing,
            facts=facts,
        )
    except FormulaError as error:
        raise FormulaError(f"{path}: {error.reason}", error.text, error.column) from None
    except SurfaceError as error:
        raise SurfaceError(f"{path}: {error}") from None


def gallery_folder() -> Path:
    """The folder of ready-made surfaces: in the source tree, else where the wheel put it.

    Raises SurfaceError when neither is there.
    """
    folders = (
        Path(__file__).resolve().parents[2] / "surfaces",
        Path(sysconfig.get_path("data")) / "share" / "surfmesh" / "surfaces",
    )
    for folder in folders:
        if (folder / "plane.toml").is_file():
            return folder
    looked = " nor ".join(map(str, folders))
    raise SurfaceError(f"the gallery of surfaces is neither in {looked}; reinstall surfmesh")


def gallery() -> dict[str, Path]:
    """Name -> formula file of every surface in the gallery, in alphabetical order."""
    return {path.stem: path for path in sorted(gallery_folder().glob("*.toml"))}


class _Entries:
    """The entries of one file, with errors that name the file and the key."""

    def __init__(self, path: Path, content: dict[str, Any]) -> None:
        self.path, self.content = path, content

    def value(self, key: str, types: tuple[type, ...], default: Any = None) -> Any:
        if key not in self.content:
            if default is not None:
                return default
            raise SurfaceError(f"{self.path}: the key '{key}' is missing")
        return self.expect(key, self.content[key], types)

    def table(self, key: str, required: bool = False) -> dict[str, Any]:
        return self.value(key, (dict,), default=None if required else {})

    def pair(self, domain: Mapping[str, Any], variable: str) -> tuple[Any, Any]:
        key = f"domain.{variable}"
        if variable not in domain:
            raise SurfaceError(f"{self.path}: the key '{key}' is missing")
        bounds = self.expect(key, domain[variable], (list,))
        if len(bounds) != 2:
            raise SurfaceError(f"{self.path}: '{key}' is a pair [first, last], not {bounds!r}")
        return tuple(self.expect(key, bound, (int, float, str)) for bound in bounds)

    def loops(self) -> list[list[tuple[float, float]]]:
        from surfmesh.geometry.expression import parse_number

        loops = []
        for number, loop in enumerate(self.value("loops", (list,), default=[])):
            key = f"loops[{number}]"
            points = []
            for point in self.expect(key, loop, (list,)):
                if not isinstance(point, list) or len(point) != 2:
                    raise SurfaceError(f"{self.path}: '{key}' holds {point!r}, not a pair [u, v]")
                for number_or_text in point:
                    self.expect(key, number_or_text, (int, float, str))
                try:
                    points.append(tuple(parse_number(x) for x in point))
                except FormulaError as error:
                    reason = f"{self.path}: '{key}': {error.reason}"
                    raise FormulaError(reason, error.text, error.column) from None
            loops.append(points)
        return loops

    def expect(self, key: str, value: Any, types: tuple[type, ...]) -> Any:
        """The value, when it has one of the types; true and false are not numbers here."""
        if not isinstance(value, types) or (isinstance(value, bool) and bool not in types):
            wanted = " or ".join(_TYPE_NAMES[t] for t in types)
            raise SurfaceError(f"{self.path}: '{key}' must be {wanted}, not {value!r:.60}")
        return value

    def refuse_unknown(self, table: Mapping[str, Any], known, prefix: str) -> None:
        for key in table:
            if key not in known:
                choices = ", ".join(sorted(known))
                raise SurfaceError(f"{self.path}: unknown key '{prefix}{key}'; known: {choices}")


_TYPE_NAMES = {
    str: "text",
    int: "a whole number",
    float: "a number",
    bool: "true or false",
    list: "a list",
    dict: "a table",
}
