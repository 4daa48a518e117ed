"""Which rule decides the size at a point: all that apply there, and where sizes grow from.

    rows of the face or edge there -> the smallest, within its bounds
    size of the field there           smaller still? then it has grown from somewhere finer:
                                      the sample with the least (size + slope distance)
"""

from __future__ import annotations

from dataclasses import asdict, dataclass
from typing import Any

import numpy as np

from surfmesh.cad.centres import boundary_polygons, inner_samples
from surfmesh.cad.model import CadModel
from surfmesh.cad.selection import EVERYTHING
from surfmesh.errors import SizingError
from surfmesh.geometry.fundamental_forms import curvatures, forms_from_derivatives
from surfmesh.geometry.inside_loops import is_inside
from surfmesh.geometry.projection import closest_point
from surfmesh.geometry.surface import Surface
from surfmesh.kernels.background import scalar_sizes_at
from surfmesh.meshing.edge_samples import EdgeSamples
from surfmesh.meshing.face_data import FaceJob
from surfmesh.meshing.face_gaps import AcrossTo
from surfmesh.meshing.face_job import face_field
from surfmesh.sizing.model_sizing import ModelSizing, Rule
from surfmesh.sizing.size_bounds import SizeBounds
from surfmesh.sizing.size_field import SizeField
from surfmesh.sizing.size_rows import SizeRow, deciding, rows
from surfmesh.sizing.sizing import Sizing

GRID, PROJECTIONS = 33, 8
"""Points each way of the grid that a foot is looked for from, and steps to it."""

NEAR_FACES = 6
"""So many faces are looked at in detail."""

LOWERED = 0.97
"""A size below this share of what is asked for at the point has grown from elsewhere."""


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
    """Of the graded field at the point, model units."""
    wish: float
    """What is asked for at the point itself."""
    origin: str = ""
    """Where a size that is smaller than ``wish`` has grown from."""

    def __str__(self) -> str:
        at = ", ".join(f"{x:.6g}" for x in self.point)
        lines = [f"size {self.size:.6g} at ({at}) on {self.place}"]
        if self.origin:
            lines.append(f"grown from {self.origin}, where {self.winner.key!r} decides: "
                         f"{self.winner.rule} -> {self.winner.size:.6g}")  # fmt: skip
        else:
            lines.append(f"{self.winner.key!r} decides: {self.winner.rule}")
        lines.append("all that apply at the point:")
        lines += [f"  {row}" for row in self.rows]
        return "\n".join(lines)

    def to_dict(self) -> dict[str, Any]:
        """Plain data for JSON."""
        plain = asdict(self)
        plain["rows"] = [row._asdict() for row in self.rows]
        plain["winner"] = self.winner._asdict()
        return plain


def explain_surface(
    surface: Surface, sizing: Sizing, field: SizeField, point: np.ndarray
) -> Explanation:
    """On one surface; ``field``: what ``sizing`` makes of it."""
    grid = _grid(surface, GRID)
    uv, away, foot = _foot(surface, point, grid)
    k1, k2 = _curvature(surface, uv)
    stated = "default" if sizing.chord is None and field.sizing.chord is not None else EVERYTHING
    bounds = SizeBounds.of(sizing, _diagonal(surface, grid))
    found = list(rows(stated, field.sizing, foot, k1, k2))
    if sizing.max_size is None and np.isfinite(bounds.clamp[1]) and sizing.size is None:
        found.append(SizeRow("default", "a tenth of the diagonal", bounds.clamp[1], "max"))
    elsewhere = []
    points, *derivatives = surface.evaluate(grid, 2)
    k = curvatures(forms_from_derivatives(*derivatives))
    size = np.full(len(grid), bounds.clamp[1])
    if bounds.follows_curvature:
        size = np.minimum(size, np.nan_to_num(bounds.shorter(k.k1, k.k2), nan=np.inf))
    if field.sizing.has_law:
        size = np.minimum(size, field.sizing.law_sizes(points))
    for number in np.argsort(size + sizing.gradient * np.linalg.norm(points - foot, axis=1))[:1]:
        there = rows(stated, field.sizing, points[number], k.k1[number], k.k2[number])
        elsewhere.append((points[number], f"{_at(points[number])}", list(there)))
    return _explained(foot, away, surface.name or surface.kind, 0, found, field, uv, elsewhere)


def explain_model(
    model: CadModel, wanted: ModelSizing, samples: EdgeSamples, sizings: list[Sizing],
    jobs: list[FaceJob], point: np.ndarray,
) -> Explanation:  # fmt: skip
    """On a CAD model, of which the jobs of the first round are made."""
    number, uv, away, foot = _nearest_face(model, samples, point)
    face = model.faces[number]
    _, field = face_field(jobs[number])
    k1, k2 = _curvature(face.surface, uv) if face.kind != "plane" else (None, None)
    found = _rows_of(wanted, wanted.rules_of("faces", number), foot, k1, k2)
    found += _gaps_of(wanted, number, foot)
    elsewhere = []
    slope = wanted.base.gradient
    if len(samples.points):
        reach = samples.wish + slope * np.linalg.norm(samples.points - foot, axis=1)
        place = int(np.argmin(reach))
        elsewhere.append(_at_sample(model, wanted, samples, place))
    inner = inner_samples(face, GRID)
    if len(inner):
        (points, *derivatives) = face.surface.evaluate(inner, 2)
        bounds = SizeBounds.of(sizings[number], model.diagonal)
        size = np.full(len(inner), bounds.clamp[1])
        k = curvatures(forms_from_derivatives(*derivatives))
        if bounds.follows_curvature:
            size = np.nan_to_num(bounds.shorter(k.k1, k.k2), nan=np.inf)
        if sizings[number].has_law:
            size = np.minimum(size, sizings[number].law_sizes(points))
        best = int(np.argmin(size + slope * np.linalg.norm(points - foot, axis=1)))
        there = _rows_of(
            wanted, wanted.rules_of("faces", number), points[best], k.k1[best], k.k2[best]
        )
        there += _gaps_of(wanted, number, points[best])
        elsewhere.append((points[best], f"face {number} at {_at(points[best])}", there))
    place = f"face {number} ({face.name or face.kind})"
    return _explained(foot, away, place, number, found, field, uv, elsewhere, slope)


def _explained(
    foot: np.ndarray, away: float, place: str, number: int, found: list[SizeRow],
    field: SizeField, uv: np.ndarray, elsewhere: list, slope: float | None = None,
) -> Explanation:  # fmt: skip
    """elsewhere: (point (3,), its name, rows there) that the size may have grown from."""
    slope = field.sizing.gradient if slope is None else slope
    out = np.empty(1)
    scalar_sizes_at(field.background, field.scaling.to_plane(uv[None]), out)
    size = float(out[0])
    winner = deciding(found)
    wish = winner.size if winner else np.inf
    origin = ""
    if size < LOWERED * wish:
        candidates = [(p, name, deciding(there)) for p, name, there in elsewhere]
        candidates = [c for c in candidates if c[2] is not None]
        if candidates:
            best = min(candidates, key=lambda c: c[2].size + slope * np.linalg.norm(c[0] - foot))
            origin, winner = best[1], best[2]
    if winner is None:
        winner = SizeRow("default", "the field's largest size", size)
    order = {"": 0, "max": 1, "min": 2}
    listed = tuple(sorted(found, key=lambda row: (order[row.bound], row.size)))
    return Explanation(
        tuple(float(x) for x in foot), float(away), place, number, listed, winner, size,
        float(wish), origin,
    )  # fmt: skip


def _rows_of(
    wanted: ModelSizing, rules: list[Rule], point: np.ndarray, k1: float | None,
    k2: float | None,
) -> list[SizeRow]:  # fmt: skip
    """Of the whole model, then of the selections. What is a default is called so."""
    stated, base = wanted.stated, wanted.base
    found = []
    overruled = {
        name for name in ("chord", "max_size")
        if getattr(stated, name) is None and rules and any(
            getattr(rule.sizing, given) is not None
            for rule in rules
            for given in (("chord", "angle", "size") if name == "chord" else ("max_size", "size"))
        )
    }  # fmt: skip
    for row in rows(EVERYTHING, base, point, k1, k2):
        option = row.rule.split()[0]
        if option in overruled:
            continue
        if option in ("chord", "max_size") and getattr(stated, option) is None:
            row = row._replace(key="default")
        found.append(row)
    for rule in rules:
        found.extend(rows(rule.key, rule.sizing, point, k1, k2))
    return found


def _gaps_of(wanted: ModelSizing, number: int, point: np.ndarray) -> list[SizeRow]:
    """What the distance to other faces of the solid asks for on a face."""
    gaps = [s for s in wanted.of_face(number).sources if isinstance(s, AcrossTo)]
    found = [(gap, float(gap(point[None])[0])) for gap in gaps]
    return [SizeRow("gap_faces", repr(gap), size) for gap, size in found if np.isfinite(size)]


def _at_sample(
    model: CadModel, wanted: ModelSizing, samples: EdgeSamples, place: int
) -> tuple[np.ndarray, str, list[SizeRow]]:
    """What applies at a sample of an edge: of its faces, of itself, of its ends, its gaps."""
    edge = int(np.searchsorted(samples.first, place, side="right") - 1)
    point, share = samples.points[place], samples.share[place]
    found = []
    for number in dict.fromkeys(model.faces_of_edge(edge)):
        face = model.faces[number]
        coedge = next(c for c in face.coedges if c.edge == edge)
        flat = face.kind == "plane"
        uv = coedge.uv(np.array([share]))[0]
        k1, k2 = (None, None) if flat else _curvature(face.surface, uv)
        found += _rows_of(wanted, wanted.rules_of("faces", number), point, k1, k2)
        found += _gaps_of(wanted, number, point)
    item = model.edges[edge]
    bend = _bend(item, share)
    found += _rows_of(wanted, wanted.rules_of("edges", edge), point, bend, bend)
    ends = {0: item.start, len(range(*samples.of(edge).indices(len(samples.share)))) - 1: item.end}
    vertex = ends.get(place - int(samples.first[edge]))
    if vertex is not None:
        for rule in wanted.rules_of("vertices", vertex):
            found += rows(rule.key, rule.sizing, point, None, None)
    least = deciding(found)
    if least is None or samples.wish[place] < LOWERED * least.size:
        gap = "gap to another edge of a face, or length of the edge"
        found.append(SizeRow("gap", gap, float(samples.wish[place])))
    called = f"edge {edge}" + (f" ({item.name})" if item.name else "")
    return point, f"{called} at {_at(point)}", found


def _bend(edge: Any, share: float) -> float | None:
    """Curvature of an edge; None where it is straight."""
    if getattr(edge.curve, "kind", "") == "line":
        return None
    _, first, second = edge.curve.evaluate(edge.parameters(np.array([share])), 2)
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
            edge_uv = np.concatenate(rings)
            (places,) = face.surface.evaluate(edge_uv, 0)
            nearest = int(np.linalg.norm(places - point, axis=1).argmin())
            on_edge = float(np.linalg.norm(places[nearest] - point))
            span = np.ptp(edge_uv, axis=0)
            beside = (np.abs(edge_uv - uv) <= 1e-6 * span + 1e-12).all(axis=1).any()
            if not beside:
                uv, away, foot = edge_uv[nearest], on_edge, places[nearest]
        if best is None or away < best[0]:
            best = (away, number, uv, foot)
    if best is None:
        raise SizingError(f"{model.name or model.source!r} has no face to explain sizes on")
    return best[1], best[2], best[0], best[3]


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


def _diagonal(surface: Surface, grid: np.ndarray) -> float:
    return float(np.linalg.norm(np.ptp(surface.evaluate(grid, 0)[0], axis=0)))


def _curvature(surface: Surface, uv: np.ndarray) -> tuple[float | None, float | None]:
    forms = forms_from_derivatives(*surface.evaluate(uv[None], 2)[1:])
    if forms.degenerate[0]:
        return None, None
    k = curvatures(forms)
    return float(k.k1[0]), float(k.k2[0])


def _at(point: np.ndarray) -> str:
    return "(" + ", ".join(f"{x:.4g}" for x in point) + ")"
