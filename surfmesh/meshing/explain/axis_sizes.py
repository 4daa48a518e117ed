"""Sizes that depend on the direction: the two of the metric at a point, and the rule along each.

         h1, the shorter            W of the field -> its axes in the tangent plane
    <----->                         each axis: the ruling along the direction that is nearest to
<------------------>  h2            it -> as it is, or grown from elsewhere, or shrunk with the
                                    other
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import asdict, dataclass
from typing import Any, NamedTuple

import numpy as np

from surfmesh.geometry.differential.fundamental_forms import curvatures, forms_from_derivatives
from surfmesh.geometry.surface import Surface
from surfmesh.meshing.explain.rulings import Ruling, with_radius
from surfmesh.meshing.explain.size_row import IN_JSON, SizeRow, in_order
from surfmesh.renamed import Renamed
from surfmesh.sizing.field.size_field import SizeField
from surfmesh.sizing.metric_roots import unpacked

LOWERED = 0.97
"""A size below this fraction of what is asked for at the point has grown from elsewhere."""

ROUND = 1.02
"""Ratio of two sizes up to which the metric has no axes of its own."""

RAISED = 1.05
"""Times the size that is asked for: above it something is said of it."""

NEARLY = 1.15
"""What explains a size predicts it within this factor."""

BESIDE_POLES = 1e-3
"""Fraction of the way to the middle of the domain, where a pole has directions."""


class Principal(NamedTuple):
    """Curvature at a point of a surface."""

    k: tuple[float, float] | None
    """k1 >= k2, 1 / model unit; None where there is no tangent plane."""
    along: np.ndarray
    """(2, 3) unit tangents, those of k1 and of k2."""

    @classmethod
    def at(cls, surface: Surface, uv: np.ndarray) -> Principal:
        """uv: (2,)"""
        found = cls._at(surface, uv)
        if found.k is None:  # a pole: the directions a little way off
            middle = np.mean(surface.domain, axis=1)
            found = cls(None, cls._at(surface, uv + BESIDE_POLES * (middle - uv)).along)
        return found

    @classmethod
    def _at(cls, surface: Surface, uv: np.ndarray) -> Principal:
        _, r_u, r_v, *second = surface.evaluate(uv[None], 2)
        forms = forms_from_derivatives(r_u, r_v, *second)
        found = curvatures(forms)
        along = np.stack([d[0, 0] * r_u[0] + d[0, 1] * r_v[0] for d in (found.d1, found.d2)])
        length = np.linalg.norm(along, axis=1)
        if forms.degenerate[0] or not (length > 0.0).all():
            return cls(None, np.eye(3)[:2])
        return cls((float(found.k1[0]), float(found.k2[0])), along / length[:, None])

    def nearest(self, direction: np.ndarray) -> int:
        """Which of the two directions is nearer to a unit vector (3,)."""
        return int(np.abs(self.along @ direction).argmax())


@dataclass(frozen=True)
class AxisSize:
    """One of the two sizes of the metric at a point, lengths in model units."""

    size: float
    """Of the graded field."""
    direction: tuple[float, float, float]
    """Unit tangent; so is its negative."""
    curvature: float | None
    """Of the surface along it, 1 / model unit."""
    target_size: float
    """What is asked for along it at the point itself."""
    winner: SizeRow
    """The row that decides: here, or where the size has grown from."""
    rows: tuple[SizeRow, ...]
    """All that apply along it at the point, the smallest first, bounds last."""
    origin: str = ""
    """Where a size that is smaller than ``target_size`` has grown from, or what has shrunk it."""

    wish = Renamed("target_size")

    @property
    def radius(self) -> float | None:
        """Of curvature; None where it is straight along the direction."""
        return 1.0 / abs(self.curvature) if self.curvature else None

    @property
    def is_raised(self) -> bool:
        """Is it larger than what is asked for, as the other size is not reached?

        A shorter edge takes less of the chord and leaves more of it to the other one.
        """
        return self.size > RAISED * self.target_size

    def lines(self) -> list[str]:
        """As text."""
        along = ", ".join(f"{round(x, 4) + 0.0:g}" for x in self.direction)
        bend = "" if self.curvature is None else f", curvature {with_radius(self.curvature)}"
        decides = f"{self.winner.key!r} decides: {self.winner.rule}"
        if self.origin:
            decides = f"{self.origin}, where {decides} -> {self.winner.size:.6g}"
        if self.is_raised:
            decides += f" -> {self.winner.size:.6g}, raised as the other size is not reached"
        head = f"{self.size:.6g} along ({along}){bend}: {decides}"
        return [head, *(f"  {row}" for row in self.rows)]

    def to_dict(self) -> dict[str, Any]:
        """Plain data for JSON."""
        plain = {IN_JSON.get(name, name): value for name, value in asdict(self).items()}
        plain["radius"] = self.radius
        plain["rows"] = [row._asdict() for row in self.rows]
        plain["winner"] = self.winner._asdict()
        return plain


class Elsewhere(NamedTuple):
    """A place whose size may have grown to the point, along one of the axes."""

    size: float
    """Along the axis, before it has grown."""
    distance: float
    name: str
    winner: SizeRow

    def reach(self, slope: float) -> float:
        """The size that it may have grown to at the point."""
        return self.size + slope * self.distance


def field_axes(
    field: SizeField, uv: np.ndarray, principal: Principal
) -> list[tuple[float, np.ndarray]]:
    """Both sizes of the graded metric with their unit tangents (3,), the shorter first."""
    xy = field.chart.to_plane(uv[None])
    if not field.is_anisotropic:
        return [(float(field.sizes(xy)[0]), along) for along in principal.along]
    w = unpacked(field.metric_roots_3d(xy)[0])
    inverse, axes = np.linalg.eigh(principal.along @ w @ principal.along.T)
    if inverse[1] <= ROUND * inverse[0]:
        axes = np.eye(2)
        inverse = np.full(2, inverse.mean())
    tangents = axes.T @ principal.along
    found = [(1.0 / float(inverse[k]), tangents[k]) for k in (1, 0)]
    return found if inverse[1] > inverse[0] else found[::-1]


def explained_axes(
    axes: list[tuple[float, np.ndarray]],
    principal: Principal,
    asked: tuple[Ruling, Ruling],
    elsewhere: Callable[[np.ndarray, bool], list[Elsewhere]],
    slope: float,
) -> tuple[AxisSize, AxisSize]:
    """The rule along each axis of the metric.

    asked: at the point itself, along both of its directions. elsewhere: the places that come into
    question for a unit tangent (3,), and whether all directions are alike.
    """
    done: list[AxisSize] = []
    alike = axes[1][0] <= ROUND * axes[0][0]
    nearest = int(np.argmax([abs(own.direction @ axes[0][1]) for own in asked]))
    for (size, direction), own in zip(axes, (asked[nearest], asked[1 - nearest])):
        winner, origin = own.winner, ""
        if size < LOWERED * own.size:
            places = [p for p in elsewhere(direction, alike) if p.size < LOWERED * own.size]
            best = min(places, key=lambda p: p.reach(slope), default=None)
            near = best is not None and best.reach(slope) <= NEARLY * size
            if alike and done and done[0].origin:
                origin, winner = done[0].origin, done[0].winner
            elif best is not None and (near or not done):
                origin, winner = f"grown from {best.name}", best.winner
            elif done and done[0].origin:
                origin, winner = f"shrunk with the other size, {done[0].origin}", done[0].winner
            else:
                origin = "shortened as the directions of the metric change nearby"
        bend = None
        if principal.k is not None:
            first, second = principal.along @ direction
            bend = float(principal.k[0] * first**2 + principal.k[1] * second**2)
        x, y, z = map(float, direction)
        done.append(AxisSize(size, (x, y, z), bend, own.size, winner, in_order(own.rows), origin))
    return done[0], done[1]
