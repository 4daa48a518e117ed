"""Which rule decides the size at a point: all that apply there, and where sizes grow from.

    rows of the face or edge there -> the smallest, within its bounds
    size of the field there           smaller still? then it has grown from somewhere finer:
                                      the sample with the least (size + slope distance)

Where sizes depend on the direction, so along each axis of the metric: see ``axis_sizes``.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import asdict, dataclass
from typing import Any, NamedTuple

import numpy as np

from surfmesh.cad.model.cad_model import CadModel
from surfmesh.cad.model.centres import boundary_polygons, inner_samples
from surfmesh.cad.selection.selection import EVERYTHING
from surfmesh.errors import SizingError, printable
from surfmesh.geometry.differential.projection import closest_point
from surfmesh.geometry.inside_loops import is_inside
from surfmesh.geometry.surface import Surface, surface_label
from surfmesh.meshing.edges.edge_samples import EdgeSamples
from surfmesh.meshing.edges.face_proximity import AcrossTo
from surfmesh.meshing.explain.axis_sizes import (
    LOWERED,
    AxisSize,
    Elsewhere,
    Principal,
    RowMaker,
    axis_rows,
    explained_axes,
    field_axes,
    wished,
)
from surfmesh.meshing.faces.face_data import FaceJob
from surfmesh.meshing.faces.face_mesh import face_field
from surfmesh.sizing.field.size_field import SizeField
from surfmesh.sizing.field.size_law import SizeLaw
from surfmesh.sizing.options.model_sizing import ModelSizing, Rule
from surfmesh.sizing.options.sizing import Sizing
from surfmesh.sizing.rules.curvature_size import DEVIATION_RESERVE, STRAIGHT_RESERVE
from surfmesh.sizing.rules.direction_size import size_along
from surfmesh.sizing.rules.rim_size import Rims, RimSizes
from surfmesh.sizing.rules.size_bounds import SizeBounds
from surfmesh.sizing.rules.size_rows import SizeRow, deciding, rows

GRID, PROJECTIONS = 33, 8
"""Points each way of the grid that a foot is looked for from, and steps to it."""

Curvatures = tuple[float, float] | None

EXACT = 1e-6
"""Relative: sizes that differ by less are one."""

NEAR_FACES = 6
"""So many faces are looked at in detail."""


@dataclass(frozen=True)
class Explanation:
    """The size at a point, and why."""

    point: tuple[float, float, float]
    """On the surface, nearest to what was asked for."""
    distance: float
    """From there, model units."""
    place: str
    """"face 3 (fillet1)"."""
    face: int
    rows: tuple[SizeRow, ...]
    """All that apply there, the smallest first, bounds last."""
    winner: SizeRow
    """The row that decides: here, or where the size has grown from."""
    size: float
    """Of the graded field at the point, model units; the shorter of two."""
    wish: float
    """What is asked for at the point itself."""
    origin: str = ""
    """Where a size that is smaller than ``wish`` has grown from."""
    curvatures: tuple[float, float] | None = None
    """k1 >= k2 of the surface, 1 / model unit; None where it has no tangent plane."""
    axes: tuple[AxisSize, ...] = ()
    """Where sizes depend on the direction: both axes of the metric, the shorter size first. All
    of the above but ``curvatures`` is then of the shorter one."""

    @property
    def ratio(self) -> float:
        """Of the two sizes; 1 where they do not depend on the direction."""
        return self.axes[1].size / self.axes[0].size if self.axes else 1.0

    def __str__(self) -> str:
        at = ", ".join(f"{x:.6g}" for x in self.point)
        if self.axes:
            sizes = " and ".join(f"{axis.size:.6g}" for axis in self.axes)
            lines = [f"sizes {sizes} (ratio {self.ratio:.4g}) at ({at}) on {self.place}"]
        else:
            lines = [f"size {self.size:.6g} at ({at}) on {self.place}"]
        if self.curvatures is not None:
            radii = ", ".join(f"{1.0 / abs(k):.4g}" if k else "infinite" for k in self.curvatures)
            k1, k2 = self.curvatures
            lines.append(f"principal curvatures {k1:.4g}, {k2:.4g} (radii {radii})")
        if self.axes:
            lines += (line for axis in self.axes for line in axis.lines())
            return "\n".join(map(printable, lines))
        if self.origin:
            lines.append(f"grown from {self.origin}, where {self.winner.key!r} decides: "
                         f"{self.winner.rule} -> {self.winner.size:.6g}")  # fmt: skip
        else:
            lines.append(f"{self.winner.key!r} decides: {self.winner.rule}")
        lines.append("all that apply at the point:")
        lines += [f"  {row}" for row in self.rows]
        return "\n".join(map(printable, lines))

    def to_dict(self) -> dict[str, Any]:
        """Plain data for JSON."""
        plain = asdict(self)
        plain["rows"] = [row._asdict() for row in self.rows]
        plain["winner"] = self.winner._asdict()
        plain["axes"] = [axis.to_dict() for axis in self.axes]
        return plain | {"ratio": self.ratio}


def explain_surface(
    surface: Surface, sizing: Sizing, field: SizeField, point: np.ndarray,
    rims: Rims | None = None,
) -> Explanation:  # fmt: skip
    """On one surface; ``field``: what ``sizing`` makes of it, and of where the surface ends."""
    grid = _grid(surface, GRID)
    uv, away, foot = _foot(surface, point, grid)
    principal = Principal.at(surface, uv)
    stated = "default" if sizing.chord is None and field.sizing.chord is not None else EVERYTHING
    law = SizeLaw(surface, sizing, None, rims)
    bounds = law.bounds

    def rows_at(place: np.ndarray, k: Curvatures, make: RowMaker = rows) -> list[SizeRow]:
        found = list(make(stated, field.sizing, place, *(k or (None, None))))
        if sizing.max_size is None and np.isfinite(bounds.clamp[1]) and sizing.size is None:
            if not bounds.sizing.is_anisotropic:
                found.append(SizeRow("default", "a tenth of the diagonal", bounds.clamp[1], "max"))
        return found

    name = surface_label(surface)
    where = _Where(foot, away, name, 0, uv, principal)
    if bounds.sizing.is_anisotropic:
        samples = _Samples(surface, grid, bounds, field.sizing, law)

        def others(direction: np.ndarray, alike: bool) -> list[Elsewhere]:
            return [samples.best_along(direction, foot, "", rows_at)]

        return _along_axes(where, field, bounds, rows_at, others, sizing.gradient, law)
    elsewhere = [_best_of_law(law, surface, grid, foot, "", rows_at, stated)]
    found = rows_at(foot, principal.k) + rim_rows(law, uv, stated)
    asked = float(law(law.chart.to_plane(uv[None])).size[0])
    return _explained(where, found, asked, field, elsewhere, sizing.gradient)


def explain_model(
    model: CadModel, wanted: ModelSizing, samples: EdgeSamples, sizings: list[Sizing],
    jobs: list[FaceJob], point: np.ndarray,
) -> Explanation:  # fmt: skip
    """On a CAD model, of which the jobs of the first round are made."""
    number, uv, away, foot = _nearest_face(model, samples, point)
    face = model.faces[number]
    surface, field = face_field(jobs[number])
    principal = Principal.at(face.surface, uv)
    rules = wanted.rules_of("faces", number)
    slope = wanted.base.gradient
    bounds = SizeBounds.of(sizings[number], model.diagonal)
    inner = inner_samples(face, GRID)

    def rows_at(place: np.ndarray, k: Curvatures, make: RowMaker = rows) -> list[SizeRow]:
        k = None if face.kind == "plane" else k
        found = _rows_of(wanted, rules, place, *(k or (None, None)), make)
        return found + _gaps_of(wanted, number, place)

    name = face.label(number)
    if number in samples.narrow:
        across = samples.narrow[number].width
        name += f", {across:.3g} across and so closed between its sides: sizes inside do not count"
    where = _Where(foot, away, name, number, uv, principal)
    if wanted.is_anisotropic:
        within = _Samples(face.surface, inner, bounds, sizings[number]) if len(inner) else None

        def others(direction: np.ndarray, alike: bool) -> list[Elsewhere]:
            found = []
            if within is not None:
                found.append(within.best_along(direction, foot, f"face {number} at ", rows_at))
            if len(samples.points):
                every = alike or wanted.of_face(number).gap is not None
                along = None if every else direction
                found.append(_best_sample(model, wanted, samples, along, foot))
            return found

        return _along_axes(where, field, bounds, rows_at, others, slope)
    elsewhere = []
    if len(samples.points):
        reach = samples.target_size + slope * np.linalg.norm(samples.points - foot, axis=1)
        place = int(np.argmin(reach))
        elsewhere.append(_at_sample(model, wanted, samples, place))
    law = SizeLaw(surface, sizings[number], None)
    if len(inner):
        name = f"face {number} at "
        elsewhere.append(_best_of_law(law, surface, inner, foot, name, rows_at, EVERYTHING))
    asked = float(law(law.chart.to_plane(uv[None])).size[0])
    return _explained(where, rows_at(foot, principal.k), asked, field, elsewhere, slope)


def rim_rows(
    law: SizeLaw, uv: np.ndarray, key: str, direction: np.ndarray | None = None
) -> list[SizeRow]:
    """What the rims of a surface ask for at uv (2,); direction: unit (3,), None: in all."""
    if law.rims is None:
        return []
    (point,) = law.surface.evaluate(uv[None], 0)
    found = []
    for rows_, rim, allowed in law.rims_at(law.chart.to_plane(uv[None]), uv[None], point):
        if not len(rows_) or not np.isfinite(allowed[0]):
            continue
        size = float(allowed[0])
        if direction is not None:
            size = float(rim.along(point, direction[None, None])[0, 0])
        kind = "the rim's" if isinstance(rim, RimSizes) else "a trimming loop's"
        rule = f"chord {law.sizing.chord:g} at {kind} own curvature"
        found.append(SizeRow(key, rule, max(size, law.clamp[0])))
    return found


def _best_of_law(
    law: SizeLaw, surface: Surface, uv: np.ndarray, foot: np.ndarray, name: str,
    rows_at: Callable, key: str,
) -> tuple[np.ndarray, str, SizeRow | None]:  # fmt: skip
    """Of places uv (n, 2) the one whose size, as the field has it before gradation, reaches
    farthest below others at ``foot``: the point, its name, the rule there."""
    nodes = law(law.chart.to_plane(uv))
    away = np.linalg.norm(nodes.point - foot, axis=1)
    best = int(np.argmin(nodes.size + law.sizing.gradient * away))
    place = nodes.point[best]
    there = rows_at(place, Principal.at(surface, uv[best]).k) + rim_rows(law, uv[best], key)
    return place, f"{name}{_at(place)}", _decided(there, float(nodes.size[best]))


def _decided(found: list[SizeRow], asked: float) -> SizeRow | None:
    """The row that decides; where the field asks for another size, ``found`` gains the bound that
    it has by itself."""
    winner = deciding(found)
    if winner is None or winner.size > asked * (1.0 + EXACT):
        rule = "the largest size, where nothing else is said"
        found.append(SizeRow("default", rule, asked, "max"))
    elif winner.size < asked * (1.0 - EXACT):
        rule = "no size is smaller, unless min_size says so"
        found.append(SizeRow("default", rule, asked, "min"))
    return deciding(found)


class _Where(NamedTuple):
    """The point that is explained."""

    foot: np.ndarray  # (3,)
    away: float
    place: str
    face: int
    uv: np.ndarray  # (2,)
    principal: Principal


class _Samples:
    """Points of a surface, with the sizes that depend on the direction there."""

    def __init__(
        self, surface: Surface, uv: np.ndarray, bounds: SizeBounds, sizing: Sizing,
        rims: SizeLaw | None = None,
    ) -> None:  # fmt: skip
        """rims: the law that knows those of the surface."""
        self.rims = rims
        self.surface, self.uv, self.bounds, self.sizing = surface, uv, bounds, sizing
        (self.points,) = surface.evaluate(uv, 0)
        self.law = sizing.law_sizes(self.points) if sizing.has_law else np.full(len(uv), np.inf)

    def best_along(
        self, direction: np.ndarray, foot: np.ndarray, name: str, rows_at: Callable
    ) -> Elsewhere:
        """Where the size along a unit vector (3,) reaches farthest below others."""
        size = np.full(len(self.uv), self.bounds.longest)
        if self.bounds.follows_curvature:
            every = np.tile(direction, (len(self.uv), 1))
            np.fmin(size, size_along(self.surface, self.uv, every, self.bounds), out=size)
        np.minimum(size, self.law, out=size)
        if self.rims is not None:
            xy = self.rims.chart.to_plane(self.uv)
            for some, rim, _ in self.rims.rims_at(xy, self.uv, self.points):
                every = np.broadcast_to(direction, (1, len(some), 3))
                size[some] = np.minimum(size[some], rim.along(self.points[some], every)[0])
        away = np.linalg.norm(self.points - foot, axis=1)
        best = int(np.argmin(size + self.sizing.gradient * away))
        place = self.points[best]
        principal = Principal.at(self.surface, self.uv[best])
        axis = principal.nearest(direction)
        there = rows_at(place, principal.k, axis_rows(axis, self.bounds.sizing.anisotropy))
        _, winner = wished(there, axis, principal.k, self.bounds, float(self.law[best]))
        if self.rims is not None:
            rims = rim_rows(self.rims, self.uv[best], EVERYTHING, direction)
            winner = min([winner, *rims], key=lambda row: row.size)
        return Elsewhere(float(size[best]), float(away[best]), f"{name}{_at(place)}", winner)


def _best_sample(
    model: CadModel, wanted: ModelSizing, samples: EdgeSamples, direction: np.ndarray | None,
    foot: np.ndarray,
) -> Elsewhere:  # fmt: skip
    """The edge whose size along a unit vector (3,) reaches farthest below others.

    A size along an edge says nothing of directions across it; None: it holds in all of them.
    """
    size = samples.target_size
    if direction is not None:
        size = size / np.maximum(np.abs(samples.tangent @ direction), np.finfo(float).eps)
    away = np.linalg.norm(samples.points - foot, axis=1)
    best = int(np.argmin(size + wanted.base.gradient * away))
    _, name, winner = _at_sample(model, wanted, samples, best)
    return Elsewhere(float(size[best]), float(away[best]), name, winner)


def _along_axes(
    where: _Where, field: SizeField, bounds: SizeBounds, rows_at: Callable,
    others: Callable[[np.ndarray, bool], list[Elsewhere]], slope: float,
    rims: SizeLaw | None = None,
) -> Explanation:  # fmt: skip
    """By the axes of the metric at the point; rims: the law that knows those of the surface."""
    foot, k = where.foot, where.principal.k
    sizing = bounds.sizing
    law = float(sizing.law_sizes(foot[None])[0]) if sizing.has_law else np.inf

    def rows_of(axis: int) -> tuple[float, SizeRow, list[SizeRow]]:
        found = rows_at(foot, k, axis_rows(axis, sizing.anisotropy))
        wish, winner = wished(found, axis, k, bounds, law)
        if rims is not None:
            own = rim_rows(rims, where.uv, EVERYTHING, where.principal.along[axis])
            found.extend(own)
            winner = min([winner, *own], key=lambda row: row.size)
        return min(wish, winner.size), winner, found

    found = field_axes(field, where.uv, where.principal)
    axes = explained_axes(found, where.principal, rows_of, others, slope)
    first = axes[0]
    at = tuple(float(x) for x in foot)
    return Explanation(
        at, float(where.away), where.place, where.face, first.rows, first.winner, first.size,
        first.wish, first.origin, k, axes,
    )  # fmt: skip


def _explained(
    where: _Where, found: list[SizeRow], wish: float, field: SizeField, elsewhere: list,
    slope: float,
) -> Explanation:  # fmt: skip
    """wish: of the field before gradation; elsewhere: (point (3,), its name, rule there) that the
    size may have grown from."""
    foot = where.foot
    size = float(field.sizes(field.chart.to_plane(where.uv[None]))[0])
    winner = _decided(found, wish)
    origin = ""
    if size < LOWERED * wish:
        candidates = [c for c in elsewhere if c[2] is not None]
        if candidates:
            best = min(candidates, key=lambda c: c[2].size + slope * np.linalg.norm(c[0] - foot))
            origin, winner = best[1], best[2]
    if winner is None:
        winner = SizeRow("default", "the field's largest size", size)
    order = {"": 0, "max": 1, "min": 2}
    listed = tuple(sorted(dict.fromkeys(found), key=lambda row: (order[row.bound], row.size)))
    return Explanation(
        tuple(float(x) for x in foot), float(where.away), where.place, where.face, listed, winner,
        size, float(wish), origin, where.principal.k,
    )  # fmt: skip


def _rows_of(
    wanted: ModelSizing, rules: list[Rule], point: np.ndarray, k1: float | None,
    k2: float | None, make: RowMaker = rows,
) -> list[SizeRow]:  # fmt: skip
    """Of the whole model, then of the selections. What is a default is called so."""
    stated, base = wanted.stated, wanted.base
    found = []
    overruled = {
        name for name in ("chord", "max_size")
        if getattr(stated, name) is None and rules and any(
            getattr(rule.sizing, given) is not None
            for rule in rules if not rule.derived
            for given in (("chord", "angle", "size") if name == "chord" else ("max_size", "size"))
        )
    }  # fmt: skip
    for row in make(EVERYTHING, base, point, k1, k2):
        option = row.rule.split()[0]
        if option in overruled:
            continue
        if option in ("chord", "max_size") and getattr(stated, option) is None:
            row = row._replace(key="default")
        found.append(row)
    for rule in rules:
        found.extend(make(rule.key, rule.sizing, point, k1, k2))
    return found


def _gaps_of(wanted: ModelSizing, number: int, point: np.ndarray) -> list[SizeRow]:
    """What the distance to other faces of the solid asks for on a face."""
    gaps = [s for s in wanted.of_face(number).sources if isinstance(s, AcrossTo)]
    found = [(gap, float(gap(point[None])[0])) for gap in gaps]
    return [SizeRow("gap_faces", repr(gap), size) for gap, size in found if np.isfinite(size)]


def _at_sample(
    model: CadModel, wanted: ModelSizing, samples: EdgeSamples, place: int
) -> tuple[np.ndarray, str, SizeRow]:
    """The rule at a sample of an edge: of its faces, of itself, of its ends, its gaps.

    Each face is heard within its own bounds; the smallest of their sizes holds.
    """
    edge = int(np.searchsorted(samples.first, place, side="right") - 1)
    point, share = samples.points[place], samples.share[place]
    item = model.edges[edge]
    bend = _bend(item, share)
    groups = []
    for number in dict.fromkeys(model.faces_of_edge(edge)):
        face = model.faces[number]
        coedge = next(c for c in face.coedges if c.edge == edge)
        uv = coedge.uv(np.array([share]))[0]
        principal = Principal.at(face.surface, uv)
        make = rows
        if wanted.is_anisotropic:  # along the edge
            axis = principal.nearest(samples.tangent[place])
            make = axis_rows(axis, wanted.base.anisotropy)
        k1, k2 = (None, None) if face.kind == "plane" else principal.k or (None, None)
        rules = wanted.rules_of("faces", number)
        found = _rows_of(wanted, rules, point, k1, k2, make)
        found += _own_curvature(wanted, rules, bend)
        groups.append(found + _gaps_of(wanted, number, point))
    rules = wanted.rules_of("edges", edge)
    if rules or not groups:
        groups.append(_rows_of(wanted, rules, point, bend, bend))
    ends = {0: item.start, len(range(*samples.of(edge).indices(len(samples.share)))) - 1: item.end}
    vertex = ends.get(place - int(samples.first[edge]))
    if vertex is not None:
        for rule in wanted.rules_of("vertices", vertex):
            groups.append(list(rows(rule.key, rule.sizing, point, None, None)))
    winners = [row for row in map(deciding, groups) if row is not None]
    least = min(winners, key=lambda row: row.size, default=None)
    wish = float(samples.target_size[place])
    if least is None or wish < LOWERED * least.size:
        rule = "gap to another edge of a face"
        if wish > LOWERED * item.length:
            rule = f"length {item.length:.4g} of edge {edge}"
        least = SizeRow("gap" if rule.startswith("gap") else "default", rule, wish)
    called = f"edge {edge}" + (f" ({item.name})" if item.name else "")
    return point, f"{called} at {_at(point)}", least


def _own_curvature(wanted: ModelSizing, rules: list[Rule], bend: float | None) -> list[SizeRow]:
    """What the smallest chord asks for because the edge itself is curved."""
    chords = [(EVERYTHING, wanted.base.chord), *((r.key, r.sizing.chord) for r in rules)]
    given = [(chord, key) for key, chord in chords if chord is not None]
    if not given or not bend:
        return []
    chord, key = min(given)
    reserve = STRAIGHT_RESERVE if wanted.is_anisotropic else DEVIATION_RESERVE
    size = max(float(np.sqrt(8.0 * reserve * chord / bend)), 2.0 * chord)
    rule = f"chord {chord:g} at the edge's own curvature {bend:.4g} (radius {1.0 / bend:.4g})"
    return [SizeRow(key, rule, size)]


def _bend(edge: Any, share: float) -> float | None:
    """Curvature of an edge; None where it is straight."""
    if edge.is_straight:
        return None
    _, first, second = edge.evaluate(np.array([share]), 2)
    speed = float(np.linalg.norm(first[0]))
    return float(np.linalg.norm(np.cross(first[0], second[0]))) / max(speed**3, 1e-300)


def _nearest_face(
    model: CadModel, samples: EdgeSamples, point: np.ndarray
) -> tuple[int, np.ndarray, float, np.ndarray]:
    """face, uv (2,), distance, foot (3,): inside the loops of the face."""
    best: tuple[float, int, np.ndarray, np.ndarray] | None = None
    order = []
    for number, face in enumerate(model.faces):
        grid = inner_samples(face, 9)
        places = face.surface.evaluate(grid, 0)[0] if len(grid) else np.empty((0, 3))
        places = np.concatenate([places, samples.points[samples.along(number)]])
        nearest = np.linalg.norm(places - point, axis=1).min() if len(places) else np.inf
        order.append((float(nearest), number))
    for _, number in sorted(order)[:NEAR_FACES]:
        face = model.faces[number]
        rings = boundary_polygons(face)
        uv, away, foot = _foot(face.surface, point, _grid(face.surface, GRID))
        if not is_inside(rings, uv[None])[0]:
            uv, away, foot = _on_rings(face.surface, rings, point)
        if best is None or away < best[0]:
            best = (away, number, uv, foot)
    if best is None:
        raise SizingError(f"{model.name or model.source!r} has no face to explain sizes on")
    return best[1], best[2], best[0], best[3]


def _on_rings(
    surface: Surface, rings: list[np.ndarray], point: np.ndarray
) -> tuple[np.ndarray, float, np.ndarray]:
    """uv (2,), distance, foot (3,): the nearest point of the boundary of a face."""
    start = np.concatenate(rings)
    end = np.concatenate([np.roll(ring, -1, axis=0) for ring in rings])
    (a,), (b,) = surface.evaluate(start, 0), surface.evaluate(end, 0)
    step = b - a
    square = np.maximum(np.einsum("ij,ij->i", step, step), np.finfo(float).tiny)
    share = np.clip(np.einsum("ij,ij->i", point - a, step) / square, 0.0, 1.0)[:, None]
    uv = start + share * (end - start)
    (places,) = surface.evaluate(uv, 0)
    away = np.linalg.norm(places - point, axis=1)
    nearest = int(away.argmin())
    return uv[nearest], float(away[nearest]), places[nearest]


def _foot(
    surface: Surface, point: np.ndarray, grid: np.ndarray
) -> tuple[np.ndarray, float, np.ndarray]:
    (points,) = surface.evaluate(grid, 0)
    guess = grid[np.linalg.norm(points - point, axis=1).argmin()]
    uv, away, foot = closest_point(surface, point[None], guess[None], PROJECTIONS, 0.0)
    return uv[0], float(away[0]), foot[0]


def _grid(surface: Surface, count: int) -> np.ndarray:
    (u0, u1), (v0, v1) = surface.domain
    u, v = np.linspace(u0, u1, count), np.linspace(v0, v1, count)
    return np.stack(np.meshgrid(u, v), axis=-1).reshape(-1, 2)


def _at(point: np.ndarray) -> str:
    return "(" + ", ".join(f"{x:.4g}" for x in point) + ")"
