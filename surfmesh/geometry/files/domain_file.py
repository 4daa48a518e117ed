"""Planar domains as TOML files.

name = "plate"                              outer: one loop [[x, y], ...], or a list of loops
description = "one line"                    holes, constraints: lists of loops and polylines
outer = [[0, 0], [4, 0], [4, 3], [0, 3]]    points: places that become vertices
holes = [[[1, 1], [2, 1], [2, 2]]]          crossings: "refuse" or "split"
constraints = [[[0, 2.5], [4, 2.5]]]        [sizing] defaults as for formula files
points = [[3, 1]]                           [sizing.distance] sizes by the distance to all
crossings = "split"                             lines and points: near there, far from reach on
[sizing.distance]                           [facts] what is known: area, regions, euler
near = 0.02
far = 0.2
reach = 1.0

merge and simplify: distances, see ``PlanarDomain``.
"""

from __future__ import annotations

from pathlib import Path

from surfmesh.errors import DomainError
from surfmesh.geometry.files.formula_file import SIZING_KEYS
from surfmesh.geometry.files.toml_entries import TomlEntries
from surfmesh.geometry.planar.planar_domain import PlanarDomain

LINES = ("outer", "holes", "constraints", "points")
DISTANCES = ("merge", "simplify")
KEYS = {"name", "description", "crossings", "sizing", "facts", *LINES, *DISTANCES}
DISTANCE_KEYS = ("near", "far", "reach")
FACT_KEYS = {"area": (int, float), "regions": (int,), "euler": (int,)}


def load_domain_file(path: str | Path) -> PlanarDomain:
    """The domain of a TOML file.

    ``sizing_defaults`` holds the table ``[sizing]`` as it is, with the table ``distance`` in it.

    Raises DomainError that names the file, and the key for anything missing, unknown or of the
    wrong type.
    """
    path = Path(path)
    entries = TomlEntries(path, DomainError)
    entries.refuse_unknown(entries.content, KEYS, "")
    sizing = entries.table("sizing")
    entries.refuse_unknown(sizing, SIZING_KEYS | {"distance"}, "sizing.")
    distance = entries.expect("sizing.distance", sizing.get("distance", {}), (dict,))
    entries.refuse_unknown(distance, DISTANCE_KEYS, "sizing.distance.")
    for key in DISTANCE_KEYS if "distance" in sizing else ():
        if key not in distance:
            raise DomainError(f"{path}: the key 'sizing.distance.{key}' is missing")
        entries.expect(f"sizing.distance.{key}", distance[key], (int, float))
    if "distance" in sizing and "size" in sizing:
        raise DomainError(f"{path}: 'sizing.size' and 'sizing.distance' exclude each other")
    for key, value in sizing.items():
        if key != "distance":
            entries.expect(f"sizing.{key}", value, (int, float))
    facts = entries.table("facts")
    entries.refuse_unknown(facts, FACT_KEYS, "facts.")
    for key, value in facts.items():
        entries.expect(f"facts.{key}", value, FACT_KEYS[key])
    lines = [entries.value("outer", (list,))]
    lines += [entries.value(key, (list,), default=[]) for key in LINES[1:]]
    try:
        return PlanarDomain(
            *lines,
            crossings=entries.value("crossings", (str,), default="refuse"),
            **{
                key: entries.value(key, (int, float)) for key in DISTANCES if key in entries.content
            },
            name=entries.value("name", (str,)),
            description=entries.value("description", (str,), default=""),
            sizing_defaults=sizing,
            facts=facts,
        )
    except DomainError as error:
        reason = str(error)
        raise DomainError(reason if reason.startswith(str(path)) else f"{path}: {reason}") from None
