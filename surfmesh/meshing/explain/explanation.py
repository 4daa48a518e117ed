"""Which rule decides the size at a point: all that apply there, and where sizes grow from.

    rules of the face there     -> the least, within its bounds (see ``rulings``)
    size of the field there        smaller still? then it has grown from somewhere finer:
                                   the place with the least (size + slope distance)

Where sizes depend on the direction, so along each axis of the metric: see ``axis_sizes``.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import asdict, dataclass
from typing import Any, NamedTuple

import numpy as np

from surfmesh.cad.model.cad_model import CadModel
from surfmesh.cad.model.centres import inner_samples
from surfmesh.cad.selection.selection import EVERYTHING
from surfmesh.errors import printable
from surfmesh.geometry.parameter_grid import parameter_grid
from surfmesh.geometry.surface import Surface, surface_label
from surfmesh.meshing.edges.edge_rules import EdgeRules
from surfmesh.meshing.edges.edge_samples import EdgeSamples
from surfmesh.meshing.explain.askers import Askers
from surfmesh.meshing.explain.axis_sizes import (
    LOWERED,
    AxisSize,
    Elsewhere,
    Principal,
    explained_axes,
    field_axes,
)
from surfmesh.meshing.explain.nearest_place import (
    GRID,
    nearest_on_model,
    nearest_on_surface,
)
from surfmesh.meshing.explain.origins import EdgePlaces, InnerPlaces
from surfmesh.meshing.explain.rulings import ruling, rulings
from surfmesh.meshing.explain.size_row import IN_JSON, SizeRow, in_order
from surfmesh.meshing.faces.face_data import FaceJob
from surfmesh.meshing.faces.face_mesh import face_field
from surfmesh.renamed import Renamed
from surfmesh.sizing.field.size_field import SizeField
from surfmesh.sizing.field.size_law import SizeLaw
from surfmesh.sizing.options.model_sizing import ModelSizing
from surfmesh.sizing.options.sizing import Sizing


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
    target_size: float
    """What is asked for at the point itself."""
    origin: str = ""
    """Where a size that is smaller than ``target_size`` has grown from."""
    curvatures: tuple[float, float] | None = None
    """k1 >= k2 of the surface, 1 / model unit; None where it has no tangent plane."""
    axes: tuple[AxisSize, ...] = ()
    """Where sizes depend on the direction: both axes of the metric, the shorter size first. All
    of the above but ``curvatures`` is then of the shorter one."""

    wish = Renamed("target_size")

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
        plain = {IN_JSON.get(name, name): value for name, value in asdict(self).items()}
        plain["rows"] = [row._asdict() for row in self.rows]
        plain["winner"] = self.winner._asdict()
        plain["axes"] = [axis.to_dict() for axis in self.axes]
        return plain | {"ratio": self.ratio}


class _Where(NamedTuple):
    """The point that is explained."""

    foot: np.ndarray  # (3,)
    away: float
    place: str
    face: int
    uv: np.ndarray  # (2,)
    principal: Principal


Origins = Callable[["np.ndarray | None", bool], list[Elsewhere]]
"""For a unit tangent (3,) at the point, None for every direction, and whether all directions are
alike: the places that the size may have grown from."""


def explain_surface(
    surface: Surface, sizing: Sizing, field: SizeField, point: np.ndarray
) -> Explanation:
    """On one surface; ``field``: what ``sizing`` makes of it."""
    places = parameter_grid(surface.domain, GRID)
    uv, away, foot = nearest_on_surface(surface, point, places)
    askers = Askers(((EVERYTHING, sizing),))
    law = _rules_alone(field)
    where = _Where(foot, away, surface_label(surface), 0, uv, Principal.at(surface, uv))
    inner = InnerPlaces(law, askers, places)

    def origins(direction: np.ndarray | None, alike: bool) -> list[Elsewhere]:
        return [inner.best(foot, direction)]

    return _explained(where, field, askers, origins)


def explain_model(
    model: CadModel, wanted: ModelSizing, samples: EdgeSamples, jobs: list[FaceJob],
    point: np.ndarray,
) -> Explanation:  # fmt: skip
    """On a CAD model, of which the jobs of the first round are made."""
    number, uv, away, foot = nearest_on_model(model, samples, point)
    face = model.faces[number]
    _, field = face_field(jobs[number])
    askers = Askers.of(wanted, "faces", number)
    name = f"face {number} ({face.name or face.kind})"
    if number in samples.narrow:
        across = samples.narrow[number].width
        name += f", {across:.3g} across and so closed between its sides: sizes inside do not count"
    where = _Where(foot, away, name, number, uv, Principal.at(face.surface, uv))
    places = inner_samples(face, GRID)
    within = f"face {number} at "
    inner = InnerPlaces(_rules_alone(field), askers, places, within) if len(places) else None
    edges = EdgePlaces(EdgeRules(model, wanted), samples) if len(samples.points) else None

    def origins(direction: np.ndarray | None, alike: bool) -> list[Elsewhere]:
        found = [] if inner is None else [inner.best(foot, direction)]
        if edges is not None:  # what gaps ask for at edges holds in every direction
            every = alike or wanted.of_face(number).gap is not None
            found.append(edges.best(foot, None if every else direction))
        return found

    return _explained(where, field, askers, origins)


def _rules_alone(field: SizeField) -> SizeLaw:
    """What the field is made from, but for the sizes of edges and of earlier rounds."""
    if not isinstance(field.law, SizeLaw):
        raise TypeError("a field of tensors has no rules to explain")
    return field.law.without_limits()


def _explained(where: _Where, field: SizeField, askers: Askers, origins: Origins) -> Explanation:
    law, slope = _rules_alone(field), field.sizing.gradient
    x, y, z = (float(x) for x in where.foot)
    place = (x, y, z), float(where.away), where.place, where.face
    k = where.principal.k
    if field.sizing.is_anisotropic:
        asked = rulings(law, askers, where.uv)
        axes = field_axes(field, where.uv, where.principal)
        both = explained_axes(axes, where.principal, asked, origins, slope)
        first = both[0]
        return Explanation(
            *place, first.rows, first.winner, first.size, first.target_size, first.origin, k, both
        )
    own = ruling(law, askers, where.uv)
    size = float(field.sizes(field.chart.to_plane(where.uv[None]))[0])
    winner, origin = own.winner, ""
    if size < LOWERED * own.size:
        best = min(origins(None, True), key=lambda p: p.reach(slope))
        winner, origin = best.winner, best.name
    return Explanation(*place, in_order(own.rows), winner, size, own.size, origin, k)
