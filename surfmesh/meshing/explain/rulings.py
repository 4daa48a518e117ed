"""What the rules of a surface say at one point, and which of them decides.

The size field takes the least of the same objects: see ``SizeLaw``.
"""

from __future__ import annotations

from collections.abc import Iterator
from typing import NamedTuple

import numpy as np

from surfmesh.geometry.differential.fundamental_forms import curvatures
from surfmesh.meshing.explain.askers import DEFAULT, Askers, bound_row, words
from surfmesh.meshing.explain.size_row import EXACT, SizeRow, deciding
from surfmesh.sizing.field.size_law import FieldNodes, Local, SizeLaw
from surfmesh.sizing.rules.rule import CurvatureRule, PlaceRule, Rule
from surfmesh.sizing.rules.size_rules import Bound, SizeRules

LARGEST = "the largest size, where nothing else is said"


class Ruling(NamedTuple):
    """Of one size at a point."""

    size: float
    """Before gradation, as the field has it."""
    winner: SizeRow
    rows: list[SizeRow]
    """All that apply."""
    direction: np.ndarray
    """(3,) unit tangent that it holds along; zero: in every direction."""


def ruling(law: SizeLaw, askers: Askers, uv: np.ndarray) -> Ruling:
    """At uv (2,), where sizes do not depend on the direction."""
    local = law.local(law.chart.to_plane(uv[None]))
    k = _curvatures(local)
    at = "" if k is None else f"at curvatures {k[0]:.4g}, {k[1]:.4g}"
    rows = []
    for rule, sizes in law.demands(local):
        if np.isfinite(sizes[0]):
            said = f"{words(rule)} {at}" if isinstance(rule, CurvatureRule) else words(rule)
            rows.append(SizeRow(askers.key_of(rule), said, float(sizes[0])))
    rows += bound_rows(law.rules, askers)
    floors = [bound_row(DEFAULT, bound) for bound in law.rules.bounds if _is_own_floor(bound)]
    winner = deciding([*rows, *floors]) or SizeRow(DEFAULT, LARGEST, law.clamp[1], "max")
    for key, other in askers.not_in(_applied(law.rules)):
        if isinstance(other, Bound):
            rows.append(bound_row(key, other))
        elif isinstance(other, PlaceRule):
            rows += _place_row(key, other, local.at.points)
        elif isinstance(other, CurvatureRule) and k is not None:
            size = float(other.sizes(np.array(k[:1]), np.array(k[1:]))[0])
            rows += [SizeRow(key, f"{words(other)} {at}", size)] if np.isfinite(size) else []
    return Ruling(winner.size, winner, [*rows, winner], np.zeros(3))


def rulings(law: SizeLaw, askers: Askers, uv: np.ndarray) -> tuple[Ruling, Ruling]:
    """At uv (2,), across and along the direction of the longer size."""
    local = law.local(law.chart.to_plane(uv[None]))
    every = curvatures(local.forms)
    k = _curvatures(local)
    found = law.after(rims=0)(local.at.xy)
    ratio = law.sizing.anisotropy
    first, second = law.rules.principal(every.k1, every.k2)[0]
    axes = (1, 0) if first > second else (0, 1)  # principal directions: across, along
    rows = [principal_rows(law.rules, askers, k, axis, local.at.points, ratio) for axis in axes]
    sizes = _both(found)
    winners = [
        _winner(own, size, other, law.rules, k)
        for own, size, other in zip(rows, sizes, reversed(sizes))
    ]
    for number, rule in enumerate(law.directed):
        at, limits = rule.limits(local.at)
        if not len(at):
            continue
        for own, direction in zip(rows, _directions(found)):
            size = float(limits.along(local.at.points, direction[None, None])[0, 0])
            if np.isfinite(size):
                own.append(SizeRow(askers.key_of(rule), words(rule), max(size, law.clamp[0])))
        found = law.after(rims=number + 1)(local.at.xy)
        for side, size in enumerate(_both(found)):
            if size < sizes[side] * (1.0 - EXACT):
                winners[side] = SizeRow(askers.key_of(rule), words(rule), size)
        sizes = _both(found)
    across, along = (
        Ruling(size, winner, [*own, winner], direction)
        for size, winner, own, direction in zip(sizes, winners, rows, _directions(found))
    )
    return across, along


def principal_rows(
    rules: SizeRules, askers: Askers, k: tuple[float, float] | None, axis: int,
    points: np.ndarray, ratio: float,
) -> list[SizeRow]:  # fmt: skip
    """What holds along principal direction 0 or 1 at points (1, 3); k: None, not known."""
    rows: list[SizeRow] = []
    applied: list[tuple[str, Rule | Bound]] = [
        (askers.key_of(rule), rule) for rule in (*rules.by_curvature, *rules.by_place)
    ]
    for key, rule in [*applied, *askers.not_in(_applied(rules))]:
        if isinstance(rule, Bound):
            rows.append(bound_row(key, rule))
        elif isinstance(rule, PlaceRule):
            rows += _place_row(key, rule, points)
        elif isinstance(rule, CurvatureRule) and k is not None:
            sizes = rule.principal_sizes(np.array(k[:1]), np.array(k[1:]), ratio)
            if np.isfinite(sizes[0, axis]):
                said = f"{words(rule)} at curvature {with_radius(k[axis])}"
                rows.append(SizeRow(key, said, float(sizes[0, axis])))
    return rows + bound_rows(rules, askers, defaults=False)


def bound_rows(rules: SizeRules, askers: Askers, defaults: bool = True) -> list[SizeRow]:
    """The bounds that are asked for; and the largest size where none is."""
    return [
        bound_row(askers.key_of(bound), bound)
        for bound in rules.bounds
        if not bound.is_default or (defaults and not bound.is_floor)
    ]


def with_radius(k: float) -> str:
    """A curvature in words."""
    return f"{k:.4g} (radius {1.0 / abs(k):.4g})" if abs(k) > np.finfo(float).tiny else "0"


def _winner(
    rows: list[SizeRow], size: float, other: float, rules: SizeRules,
    k: tuple[float, float] | None,
) -> SizeRow:  # fmt: skip
    """Of ``rows`` for a size; where none of them is as small the shape of the metric decides, or
    where all are smaller its bound. other: the size across."""
    winner = deciding(rows)
    if winner is not None and abs(winner.size - size) <= EXACT * size:
        return winner
    if winner is not None and winner.size < size:
        return next(bound_row(DEFAULT, b) for b in rules.bounds if b.is_floor)._replace(size=size)
    ratio = rules.sizing.anisotropy
    if size > other and size >= ratio * other * (1.0 - 1e-6):
        rule = f"anisotropy {ratio:g}: so many times the size {other:.6g} across, at most"
    elif k is None or size >= rules.longest * (1.0 - 1e-6):
        return SizeRow(DEFAULT, LARGEST, size, "max")
    else:
        rule = f"nearly flat: anisotropy {ratio:g} falls to {max(size / other, 1.0):.3g}"
    return SizeRow("*", rule, size, "max")


def _applied(rules: SizeRules) -> list[Rule | Bound]:
    return [*rules.by_curvature, *rules.by_place, *rules.bounds]


def _place_row(key: str, rule: PlaceRule, points: np.ndarray) -> Iterator[SizeRow]:
    size = float(rule.sizes(points)[0])
    if np.isfinite(size):
        yield SizeRow(key, words(rule), size)


def _is_own_floor(bound: Bound) -> bool:
    return bound.is_floor and bound.is_default


def _curvatures(local: Local) -> tuple[float, float] | None:
    """k1 >= k2 at one point; None where there is no tangent plane."""
    if local.forms.degenerate[0]:
        return None
    k = curvatures(local.forms)
    return float(k.k1[0]), float(k.k2[0])


def _both(found: FieldNodes) -> tuple[float, float]:
    return float(found.size[0]), float(found.long[0])


def _directions(found: FieldNodes) -> tuple[np.ndarray, np.ndarray]:
    """(3,), (3,) that the shorter and the longer size hold along."""
    return np.cross(found.normal[0], found.along[0]), found.along[0]
