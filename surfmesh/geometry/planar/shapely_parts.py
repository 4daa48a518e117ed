"""Shapely geometries taken apart into arrays."""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np
import shapely

from surfmesh.errors import DomainError


@dataclass
class Parts:
    """Arrays (k, 2) of a geometry and all its members."""

    outer: list[np.ndarray] = field(default_factory=list)
    holes: list[np.ndarray] = field(default_factory=list)
    lines: list[np.ndarray] = field(default_factory=list)
    points: list[np.ndarray] = field(default_factory=list)  # (2,) each


def parts(geometry: object) -> Parts:
    """All members of a geometry, however deep; z is ignored, what is empty is left out.

    Raises DomainError for what is not a shapely geometry.
    """
    if not isinstance(geometry, shapely.Geometry):
        raise DomainError(f"a shapely geometry is needed, not {type(geometry).__name__}")
    found = Parts()
    stack = [geometry]
    while stack:
        member = stack.pop()
        if member.is_empty:
            continue
        if isinstance(member, shapely.Polygon):
            found.outer.append(shapely.get_coordinates(member.exterior))
            found.holes += [shapely.get_coordinates(ring) for ring in member.interiors]
        elif isinstance(member, shapely.LineString):  # rings too
            found.lines.append(shapely.get_coordinates(member))
        elif isinstance(member, shapely.Point):
            found.points.append(shapely.get_coordinates(member)[0])
        else:
            stack += reversed(member.geoms)
    return found
