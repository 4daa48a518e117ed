"""Domains of the plane z = 0: outer loops, holes, islands, constraint lines and points."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from surfmesh.errors import DomainError, shown
from surfmesh.geometry.planar.given_arrays import (
    line_arrays,
    open_loop,
    point_array,
    shapely_geometries,
)
from surfmesh.geometry.planar.line_thinning import thinned
from surfmesh.geometry.planar.point_merging import (
    merged_points,
    merging_distance,
    positive_distance,
)
from surfmesh.geometry.planar.segment_distance import SegmentDistance
from surfmesh.geometry.planar.segment_graph import Line, SegmentGraph, segment_graph
from surfmesh.geometry.surface import Domain

if TYPE_CHECKING:
    from shapely.geometry.base import BaseGeometry

CROSSINGS = ("refuse", "split")
FAR_AWAY = 1e-8  # last place of the largest coordinate over the diagonal: worth a warning

_CACHED = ("_distance", "area", "regions", "warnings")


class PlaneOfCoordinates:
    """The plane z = 0 with (u, v) = (x, y), as a ``Surface``."""

    def evaluate(self, uv: np.ndarray, order: int = 0) -> tuple[np.ndarray, ...]:
        """(n, 2) float -> (n, 3) float arrays of r = (u, v, 0): see ``Surface``."""
        uv = np.asarray(uv, dtype=float).reshape(-1, 2)
        values = [np.zeros((len(uv), 3)) for _ in range((1, 3, 6)[order])]
        values[0][:, :2] = uv
        if order > 0:
            values[1][:, 0] = values[2][:, 1] = 1.0
        return tuple(values)

    def derivative_bounds(self, lo: np.ndarray, hi: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Exact bounds of r_u, r_v, r_uu, r_uv, r_vv: lower, upper, each (n, 5, 3)."""
        bounds = np.zeros((len(lo), 5, 3))
        bounds[:, 0, 0] = bounds[:, 1, 1] = 1.0
        return bounds, bounds.copy()


@dataclass(frozen=True)
class PlanarRegion(PlaneOfCoordinates):
    """One region of a planar domain: what its triangles lie on."""

    name: str
    domain: Domain
    loops: tuple[np.ndarray, ...] = ()


class _Asked(NamedTuple):
    """What is asked beside loops, lines and points; as ``PlanarDomain`` has it."""

    crossings: str
    merge: float | None
    simplify: float | None
    name: str
    description: str
    sizing_defaults: Mapping[str, Any] | None
    facts: Mapping[str, Any] | None


class PlanarDomain(PlaneOfCoordinates):
    """A part of the plane z = 0, bounded by loops; (u, v) are x and y. Immutable.

    outer: one loop (k, 2), or several: parts side by side, islands in holes. holes: loops.
    constraints: polylines (k, 2) that the mesh follows, closed where the first point is
    repeated. points: (p, 2) places that become vertices. Loops go in either direction, and
    their first point may be repeated. A place is inside when more outer loops than holes lie
    around it.

    Lines may touch, overlap and end on each other. crossings: "refuse" lines that cross, or
    "split" them there. merge: points nearer to each other are one, and lines nearer to a point
    pass through it, model units; None: 1e-9 of the diagonal. simplify: lines are thinned, and
    lie within this distance of those given; corners that stand out more, junctions, ends and
    ``points`` stay. What either has changed is in ``warnings``. description, sizing_defaults,
    facts: what is known about the domain, kept for whoever asks.

    Raises DomainError that names the loop or line for arrays of a wrong shape, coordinates
    that are not finite, loops that enclose no area, and crossings unless they are split.
    """

    def __init__(
        self,
        outer: Any,
        holes: Any = (),
        constraints: Any = (),
        points: Any = (),
        *,
        crossings: str = "refuse",
        merge: float | None = None,
        simplify: float | None = None,
        name: str = "domain",
        description: str = "",
        sizing_defaults: Mapping[str, Any] | None = None,
        facts: Mapping[str, Any] | None = None,
    ) -> None:
        outer, holes = line_arrays("outer loop", outer), line_arrays("hole", holes)
        if not outer:
            raise DomainError("there is no outer loop; give at least one loop (k, 2)")
        loops = [(f"outer loop {k}", loop, False) for k, loop in enumerate(outer)]
        loops += [(f"hole {k}", loop, True) for k, loop in enumerate(holes)]
        asked = _Asked(crossings, merge, simplify, name, description, sizing_defaults, facts)
        self._build(loops, constraints, points, asked)

    name: str
    domain: Domain  # bounding box of everything that was given
    loops: tuple[np.ndarray, ...]  # none: trimming is up to the graph
    outer: tuple[np.ndarray, ...]
    holes: tuple[np.ndarray, ...]
    constraints: tuple[np.ndarray, ...]
    points: np.ndarray
    crossings: str
    graph: SegmentGraph
    changes: tuple[str, ...]  # what was merged and thinned, in words
    description: str
    sizing_defaults: dict[str, Any]
    facts: dict[str, Any]

    @classmethod
    def from_loops(
        cls,
        loops: Any,
        constraints: Any = (),
        points: Any = (),
        *,
        crossings: str = "refuse",
        merge: float | None = None,
        simplify: float | None = None,
        name: str = "domain",
        description: str = "",
        sizing_defaults: Mapping[str, Any] | None = None,
        facts: Mapping[str, Any] | None = None,
    ) -> PlanarDomain:
        """The domain within an odd number of loops: a loop in one other is a hole, and so on.

        The rest as for the class itself.
        """
        arrays = line_arrays("loop", loops)
        labels = [f"loop {k}" for k in range(len(arrays))]
        asked = _Asked(crossings, merge, simplify, name, description, sizing_defaults, facts)
        return cls._nested(labels, arrays, constraints, points, asked)

    @classmethod
    def from_shapely(
        cls,
        geometry: BaseGeometry,
        constraints: Any = (),
        points: Any = (),
        **options: Any,
    ) -> PlanarDomain:
        """A Polygon, MultiPolygon, or a GeometryCollection of them with lines and points.

        Lines become constraints and points demanded vertices, beside those given here, which
        may be shapely geometries or arrays. options as for the class.

        Raises DomainError when there is no polygon, or for a geometry of another kind.
        """
        from surfmesh.geometry.planar.shapely_parts import parts

        taken = parts(geometry)
        more = [parts(lines) for lines in shapely_geometries(constraints)]
        places = [parts(place) for place in shapely_geometries(points)]
        if not taken.outer:
            raise DomainError("the shapely geometry holds no polygon; a domain needs one")
        lines = taken.lines + [line for part in more for line in part.outer + part.holes]
        lines += [line for part in more for line in part.lines]
        lines += [] if more else line_arrays("constraint", constraints)
        dots = taken.points + [point for part in places for point in part.points]
        dots += [] if places else list(point_array(points))
        return cls(taken.outer, taken.holes, lines, dots, **options)

    @classmethod
    def from_svg(
        cls,
        source: str | Path,
        tolerance: float | None = None,
        constraints: Any = (),
        points: Any = (),
        *,
        crossings: str = "refuse",
        merge: float | None = None,
        simplify: float | None = None,
        name: str | None = None,
        description: str = "",
        sizing_defaults: Mapping[str, Any] | None = None,
        facts: Mapping[str, Any] | None = None,
    ) -> PlanarDomain:
        """The domain that an SVG file, or its text, draws.

        Closed subpaths are loops, with even-odd nesting; open ones are constraints. Lengths are
        the drawing's user units, the y axis is turned to point upwards: y = -y of the drawing.
        tolerance: largest distance between a curve and its polyline; a thousandth of the
        drawing's diagonal when it is not given.

        Raises DomainError for a drawing that cannot be read or that holds no closed path.
        """
        from surfmesh.geometry.planar.svg_paths import svg_paths

        drawing = svg_paths(source, tolerance)
        if not drawing.loops:
            raise DomainError(f"{drawing.name}: the drawing holds no closed path")
        lines = list(drawing.lines) + line_arrays("constraint", constraints)
        called = name or drawing.name
        asked = _Asked(crossings, merge, simplify, called, description, sizing_defaults, facts)
        return cls._nested(drawing.labels, drawing.loops, lines, points, asked)

    @classmethod
    def _nested(
        cls,
        labels: Sequence[str],
        loops: Sequence[np.ndarray],
        constraints: Any,
        points: Any,
        asked: _Asked,
    ) -> PlanarDomain:
        from surfmesh.geometry.inside_loops import nesting_depth

        loops = [open_loop(label, loop) for label, loop in zip(labels, loops)]
        if not loops:
            raise DomainError("there is no loop; give at least one loop (k, 2)")
        odd = nesting_depth(loops) % 2 == 1
        made = cls.__new__(cls)
        made._build(list(zip(labels, loops, odd.tolist())), constraints, points, asked)
        return made

    def _build(
        self,
        loops: Sequence[tuple[str, np.ndarray, bool]],
        constraints: Any,
        points: Any,
        asked: _Asked,
    ) -> None:
        """loops: label, points, and whether it is a hole."""
        if asked.crossings not in CROSSINGS:
            raise DomainError(f'crossings is "refuse" or "split", not {shown(asked.crossings)}')
        places = point_array(points)
        polylines = line_arrays("constraint", constraints)
        closed = [open_loop(label, loop) for label, loop, _ in loops]
        lines = [
            Line(label, loop, closed=True, loop=k)
            for k, ((label, _, _), loop) in enumerate(zip(loops, closed))
        ]
        lines += [Line(f"constraint {k}", line) for k, line in enumerate(polylines)]
        lines += [Line(f"point {k}", place[None]) for k, place in enumerate(places)]
        is_hole = [hole for _, _, hole in loops]
        merge = merging_distance(lines, asked.merge)
        graph = segment_graph(lines, is_hole, asked.crossings == "split", merge)
        changes = merged_points(lines, merge)
        if asked.simplify is not None:
            graph, said = _thinned(graph, asked.simplify, places)
            closed = [_still_there(loop, graph, merge) for loop in closed]
            polylines = [_still_there(line, graph, merge, 2) for line in polylines]
            changes += said
        low, high = graph.points.min(axis=0).tolist(), graph.points.max(axis=0).tolist()
        self.__dict__.update(
            name=str(asked.name),
            domain=tuple(zip(low, high)),
            loops=(),
            outer=tuple(_frozen(loop) for loop, hole in zip(closed, is_hole) if not hole),
            holes=tuple(_frozen(loop) for loop, hole in zip(closed, is_hole) if hole),
            constraints=tuple(map(_frozen, polylines)),
            points=_frozen(places),
            crossings=asked.crossings,
            graph=graph,
            changes=tuple(changes),
            description=str(asked.description),
            sizing_defaults=dict(asked.sizing_defaults or {}),
            facts=dict(asked.facts or {}),
        )

    def distance(self, points: np.ndarray) -> np.ndarray:
        """Exact distance to the nearest boundary, constraint line or point.

        points: (n, 2) or (n, 3) float -> (n,).
        """
        points = np.asarray(points, dtype=float)
        if points.ndim != 2 or points.shape[1] not in (2, 3):
            raise DomainError(f"points have shape {points.shape}, not (n, 2) or (n, 3)")
        if points.shape[1] == 2:
            points = np.column_stack([points, np.zeros(len(points))])
        return self._distance(points)

    @cached_property
    def _distance(self) -> SegmentDistance:
        lone = self.graph.lone_points
        pieces = np.concatenate([self.graph.segments, np.stack([lone, lone], axis=1)])
        space = np.column_stack([self.graph.points, np.zeros(len(self.graph.points))])
        return SegmentDistance(space[pieces[:, 0]], space[pieces[:, 1]])

    @cached_property
    def area(self) -> float:
        """Area of the inside, square model units."""
        import shapely

        from surfmesh.geometry.planar.domain_faces import inside_faces

        return float(shapely.area(inside_faces(self.graph)).sum())

    @cached_property
    def regions(self) -> int:
        """Number of regions into which boundaries and constraints divide the inside."""
        from surfmesh.geometry.planar.domain_faces import inside_faces

        return len(inside_faces(self.graph))

    @cached_property
    def warnings(self) -> tuple[str, ...]:
        """What was given but has no effect, or costs accuracy."""
        from surfmesh.geometry.planar.domain_faces import bounded_faces

        found = list(self.changes)
        size = max(last - first for first, last in self.domain)
        if np.spacing(np.abs(self.domain).max()) > FAR_AWAY * size:
            found.append("the domain lies so far from the origin that coordinates lose digits")
        if self.graph.loop_is_hole.any():
            _, around = bounded_faces(self.graph)
            pierced = around[:, ~self.graph.loop_is_hole].any(axis=1)
            idle = self.graph.loop_is_hole & ~around[pierced].any(axis=0)
            found += [
                f"{self.graph.labels[loop]} lies outside all outer loops and has no effect"
                for loop in np.flatnonzero(idle)
            ]
        return tuple(found)

    def simplified(self, distance: float) -> PlanarDomain:
        """The domain with lines thinned by ``distance``: see ``simplify`` of the class."""
        made = PlanarDomain.__new__(PlanarDomain)
        graph, said = _thinned(self.graph, distance, self.points)
        made.__dict__.update(
            {k: v for k, v in self.__dict__.items() if k not in _CACHED},
            graph=graph,
            outer=tuple(_still_there(loop, graph, 0.0) for loop in self.outer),
            holes=tuple(_still_there(loop, graph, 0.0) for loop in self.holes),
            changes=(*self.changes, *said),
        )
        return made

    def region_surfaces(self, count: int) -> tuple[PlanarRegion, ...]:
        """The surfaces of ``count`` regions, named by number when there are several."""
        names = [self.name] if count == 1 else [f"{self.name} region {k}" for k in range(count)]
        return tuple(PlanarRegion(name, self.domain) for name in names)

    def __repr__(self) -> str:
        parts = [f"{len(self.outer)} outer", f"{len(self.holes)} holes"]
        parts += [f"{len(self.constraints)} constraints", f"{len(self.points)} points"]
        return f"PlanarDomain({self.name!r}, {', '.join(parts)})"

    def __setattr__(self, name: str, value: Any) -> None:
        raise AttributeError(f"a domain does not change; make a new one to set {name!r}")


def _thinned(
    graph: SegmentGraph, distance: Any, places: np.ndarray
) -> tuple[SegmentGraph, list[str]]:
    """The graph with thinned lines, the demanded ``places`` (p, 2) kept, and what that did, if
    anything."""
    thin = thinned(graph, positive_distance("simplify", distance), _near(graph, places))
    if len(thin.points) == len(graph.points):
        return thin, []
    return thin, [
        f"lines were thinned from {len(graph.points):,} to {len(thin.points):,} points, within "
        f"{distance:g} of those given"
    ]


def _near(graph: SegmentGraph, places: np.ndarray) -> np.ndarray:
    """(n,) bool: the points of the graph that stand for the demanded ``places`` (p, 2)."""
    from scipy.spatial import cKDTree

    found = np.zeros(len(graph.points), bool)
    if len(places):
        found[cKDTree(graph.points).query(places)[1]] = True
    return found


def _still_there(line: np.ndarray, graph: SegmentGraph, merge: float, least: int = 3) -> np.ndarray:
    """The points of a line that a thinned graph has kept; all when those are too few."""
    from scipy.spatial import cKDTree

    kept = cKDTree(graph.points).query(line)[0] <= merge
    return _frozen(line[kept] if kept.sum() >= least else line)


def _frozen(array: np.ndarray) -> np.ndarray:
    array = array.copy()
    array.setflags(write=False)
    return array
