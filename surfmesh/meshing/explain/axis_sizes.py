"""Sizes that depend on the direction: the two of the metric at a point, and the rule along each.

         h1, the shorter            W of the field -> its axes in the tangent plane
    <----->                         each axis: wishes along the principal direction that is
<------------------>  h2            nearest to it, least of them -> as it is, or grown from
                                    elsewhere, or shrunk with the other
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import asdict, dataclass
from typing import Any, NamedTuple

import numpy as np

from surfmesh.geometry.differential.fundamental_forms import curvatures, forms_from_derivatives
from surfmesh.geometry.surface import Surface
from surfmesh.sizing.field.size_field import SizeField
from surfmesh.sizing.metric_roots import unpacked
from surfmesh.sizing.options.sizing import Sizing
from surfmesh.sizing.rules.size_bounds import SizeBounds, principal_sizes
from surfmesh.sizing.rules.size_rows import SizeRow, curvature_rows, deciding, rows

LOWERED = 0.97
"""A size below this share of what is asked for at the point has grown from elsewhere."""

ROUND = 1.02
"""Ratio of two sizes up to which the metric has no axes of its own."""

NEARLY = 1.15
"""What explains a size predicts it within this factor."""

BESIDE_POLES = 1e-3
"""Share of the way to the middle of the domain, where a pole has directions."""

RowMaker = Callable[[str, Sizing, np.ndarray, "float | None", "float | None"], Iterator[SizeRow]]


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
    wish: float
    """What is asked for along it at the point itself."""
    winner: SizeRow
    """The row that decides: here, or where the size has grown from."""
    rows: tuple[SizeRow, ...]
    """All that apply along it at the point, the smallest first, bounds last."""
    origin: str = ""
    """Where a size that is smaller than ``wish`` has grown from, or what has shrunk it."""

    @property
    def radius(self) -> float | None:
        """Of curvature; None where it is straight along the direction."""
        return 1.0 / abs(self.curvature) if self.curvature else None

    def lines(self) -> list[str]:
        """As text."""
        along = ", ".join(f"{round(x, 4) + 0.0:g}" for x in self.direction)
        bend = "" if self.curvature is None else f", curvature {_with_radius(self.curvature)}"
        decides = f"{self.winner.key!r} decides: {self.winner.rule}"
        if self.origin:
            decides = f"{self.origin}, where {decides} -> {self.winner.size:.6g}"
        head = f"{self.size:.6g} along ({along}){bend}: {decides}"
        return [head, *(f"  {row}" for row in self.rows)]

    def to_dict(self) -> dict[str, Any]:
        """Plain data for JSON."""
        plain = asdict(self) | {"radius": self.radius}
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


def axis_rows(axis: int, ratio: float) -> RowMaker:
    """``size_rows.rows`` along the principal direction 0 or 1 alone; ratio: ``anisotropy``."""

    def along(
        key: str, sizing: Sizing, point: np.ndarray, k1: float | None, k2: float | None
    ) -> Iterator[SizeRow]:
        if k1 is not None:
            both = np.array([k1]), np.array([k2])
            at = f"at curvature {_with_radius((k1, k2)[axis])}"
            found = principal_sizes(sizing, *both, ratio)
            yield from curvature_rows(key, sizing, at, {n: s[0, axis] for n, s in found.items()})
        yield from rows(key, sizing, point, None, None)

    return along


def wished(
    found: list[SizeRow], axis: int, k: tuple[float, float] | None, bounds: SizeBounds,
    law: float,
) -> tuple[float, SizeRow]:  # fmt: skip
    """The size along principal direction ``axis`` and its rule; ``found`` gains what bounds it.

    law: what laws and sources ask for in every direction, infinite for nothing.
    """
    ratio = bounds.sizing.anisotropy
    sizes = np.full(2, bounds.clamp[1])
    if k is not None and bounds.follows_curvature:
        sizes = bounds.principal(np.array([k[0]]), np.array([k[1]]))[0]
    sizes = np.minimum(sizes, max(law, bounds.clamp[0]))
    size, other = float(sizes[axis]), float(sizes[1 - axis])
    winner = deciding(found)
    if winner is None or winner.size > size * (1.0 + 1e-6):
        if size > other and size >= ratio * other * (1.0 - 1e-6):
            rule = f"anisotropy {ratio:g}: so many times the size {other:.6g} across, at most"
        elif k is None or size >= bounds.longest * (1.0 - 1e-6):
            rule = "the largest size, where nothing else is said"
        else:
            rule = f"nearly flat: anisotropy {ratio:g} falls to {max(size / other, 1.0):.3g}"
        winner = SizeRow("default" if rule.startswith("the") else "*", rule, size, "max")
        found.append(winner)
    return size, winner


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
    rows_of: Callable[[int], tuple[float, SizeRow, list[SizeRow]]],
    elsewhere: Callable[[np.ndarray, bool], list[Elsewhere]],
    slope: float,
) -> tuple[AxisSize, AxisSize]:
    """The rule along each axis of the metric.

    rows_of: wish, winner and all rows along a principal direction. elsewhere: the places that
    come into question for a unit tangent (3,), and whether all directions are alike.
    """
    done: list[AxisSize] = []
    alike = axes[1][0] <= ROUND * axes[0][0]
    taken = principal.nearest(axes[0][1])
    for (size, direction), axis in zip(axes, (taken, 1 - taken)):
        wish, winner, found = rows_of(axis)
        origin = ""
        if size < LOWERED * wish:
            places = [p for p in elsewhere(direction, alike) if p.size < LOWERED * wish]
            best = min(places, key=lambda p: p.size + slope * p.distance, default=None)
            near = best is not None and best.size + slope * best.distance <= NEARLY * size
            if alike and done and done[0].origin:
                origin, winner = done[0].origin, done[0].winner
            elif best is not None and (near or not done):
                origin, winner = f"grown from {best.name}", best.winner
            elif done and done[0].origin:
                origin, winner = f"shrunk with the other size, {done[0].origin}", done[0].winner
            else:
                origin = "shortened as the directions of the metric turn nearby"
        k = principal.k
        bend = None
        if k is not None:
            bend = float(k[0] * (principal.along[0] @ direction) ** 2
                         + k[1] * (principal.along[1] @ direction) ** 2)  # fmt: skip
        order = {"": 0, "max": 1, "min": 2}
        listed = tuple(sorted(dict.fromkeys(found), key=lambda row: (order[row.bound], row.size)))
        done.append(
            AxisSize(size, tuple(map(float, direction)), bend, wish, winner, listed, origin)
        )
    return done[0], done[1]


def _with_radius(k: float) -> str:
    return f"{k:.4g} (radius {1.0 / abs(k):.4g})" if abs(k) > np.finfo(float).tiny else "0"
