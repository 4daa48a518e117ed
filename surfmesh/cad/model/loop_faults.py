r"""What is wrong with the loops of a face however finely they are cut: decided on their curves.

    crosses           lies on another      touches             encloses nothing
      ___                ________            ______                ______
     | __|__            |  ____  |          |  /\  |              |      |
     ||__|__|           |_|____|_|          |_/__\_|              |      |  as a hole in nothing
     |___|              (part of a side)                          |______|

What edges do within their tolerance is no fault: finer cuts or small moves in (u, v) mend it.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property
from itertools import pairwise
from weakref import WeakKeyDictionary

import numpy as np

from surfmesh.cad.model.cad_model import CadCoedge, CadEdge, CadFace, CadModel
from surfmesh.cad.model.model_arrays import model_arrays
from surfmesh.geometry.boxes import diagonal
from surfmesh.geometry.cad_surfaces.face_surface import FaceSurface
from surfmesh.geometry.cad_surfaces.nurbs import BSplineCurve
from surfmesh.geometry.inside_loops import is_inside, nesting_depth
from surfmesh.geometry.planar.curve_circles import leaving
from surfmesh.geometry.planar.curve_contacts import Contact, PlaneCurve, closest, contacts
from surfmesh.geometry.small_matrices import norm, product

ROUND_PIECES, SPAN_PIECES, MOST_PIECES = 16, 4, 256
"""Pieces of conics, of each span of a spline, and at most, in which curves hardly bend."""

NEAR, NEAREST = 1e-6, 1e-10
"""Of the diagonal of the loops in (u, v): how near is a contact, at most and at least; in between
it is the tolerance of the edges."""

DEEP = 2.0
"""Times the tolerance of the edges: p-curves that cross by more cannot be taken apart."""

SLOWEST = 0.1
"""Least speed, of the mean, that a tolerance is translated to (u, v) with."""

LOBE_SAMPLES, BRANCH_SAMPLES = 9, 33
DOUBLINGS, MOST_RADII = 2.0 ** np.arange(8), 40
"""Circles around a contact that branches are looked at on together, and in all."""

NEARLY = 0.1
"""Of what is near: so near is it known where a branch leaves a circle."""

MOST_CONTACTS = 200
"""Contacts that are looked at: more are a fault already, or far too many for one face."""

ROUNDING = 1e-12
"""Of a place: smaller coordinates are zero."""

FLAT = 1e-9
"""Of the square of their length: loops that enclose less enclose nothing."""


@dataclass(frozen=True, eq=False)
class ExactLoops:
    """The loops of a face as curves in (u, v); what is wrong with them is found when asked for."""

    surface: FaceSurface
    loops: tuple[tuple[CadCoedge, ...], ...]
    ends: tuple[tuple[int, int], ...]
    """For each coedge the vertices where its loop enters and leaves it."""
    tolerances: tuple[float, ...]
    shared: tuple[bool, ...]
    """For each coedge: another face uses its edge too."""

    stated: str = ""
    """What was found wrong with them before."""
    repeats: bool = True
    """May an edge be walked twice the same way?"""

    @property
    def may_be_wrong(self) -> bool:
        """Is ``at_once`` to be asked for?"""
        return bool(self.stated) or self.repeats

    @cached_property
    def at_once(self) -> str:
        """What is wrong with them at a glance: found when read, or an edge twice the same way."""
        return self.stated or (_Loops.doubled(self) if self.repeats else "")

    @cached_property
    def fault(self) -> str:
        """What no size can mend, with the place; empty when there is nothing."""
        return self.at_once or _Loops(self).fault()

    @cached_property
    def touch(self) -> str:
        """Where loops touch in a point that is no common vertex; moves in (u, v) may mend it."""
        return _Loops(self).touch()


_KNOWN: WeakKeyDictionary[CadModel, list[ExactLoops]] = WeakKeyDictionary()


def exact_loops(model: CadModel) -> list[ExactLoops]:
    """Of all faces of a model; vertices by the numbers that they have in a mesh."""
    if model not in _KNOWN:
        _KNOWN[model] = _exact_loops(model)
    return _KNOWN[model]


def _exact_loops(model: CadModel) -> list[ExactLoops]:
    arrays = model_arrays(model)
    edge, back = arrays.coedge_edge, arrays.coedge_reversed
    ends = np.where(back[:, None], arrays.mesh_ends[edge][:, ::-1], arrays.mesh_ends[edge])
    lowest = np.full(len(model.edges), len(model.faces))
    highest = np.full(len(model.edges), -1)
    np.minimum.at(lowest, edge, arrays.coedge_face)
    np.maximum.at(highest, edge, arrays.coedge_face)
    shared = (lowest < highest)[edge]
    ways = [(start, end) for start, end in ends.tolist()]
    way = 2 * (arrays.coedge_face * len(model.edges) + edge) + back
    _, which, times = np.unique(way, return_inverse=True, return_counts=True)
    repeats = np.zeros(len(model.faces), bool)
    repeats[arrays.coedge_face[times[which.reshape(-1)] > 1]] = True
    tolerances, uses = arrays.tolerance[edge].tolist(), shared.tolist()
    return [
        ExactLoops(
            face.surface, tuple(face.loops), tuple(ways[a:b]), tuple(tolerances[a:b]),
            tuple(uses[a:b]), face.fault, twice,
        )
        for face, twice, (a, b) in zip(
            model.faces, repeats.tolist(), pairwise(arrays.first_of_face.tolist())
        )
    ]  # fmt: skip


def fault_of_pieces(faces: Sequence[CadFace], edges: Sequence[CadEdge], vertices: int) -> str:
    """What is wrong with the loops of several faces that were cut from one, taken together."""
    loops = [loop for face in faces for loop in face.loops]
    shared = [False] * sum(map(len, loops))
    exact = _exact(faces[0], loops, edges, np.arange(vertices), shared)
    face_of = np.repeat(np.arange(len(faces)), [len(face.loops) for face in faces])
    return _Loops(exact).fault_between(face_of)


def _exact(
    face: CadFace, loops: Sequence[tuple[CadCoedge, ...]], edges: Sequence[CadEdge],
    vertex: np.ndarray, shared: Sequence[bool],
) -> ExactLoops:  # fmt: skip
    ends, tolerances = [], []
    for coedge in (coedge for loop in loops for coedge in loop):
        edge = edges[coedge.edge]
        way = int(vertex[edge.start]), int(vertex[edge.end])
        ends.append(way[::-1] if coedge.reversed else way)
        tolerances.append(edge.tolerance)
    return ExactLoops(
        face.surface, tuple(loops), tuple(ends), tuple(tolerances), tuple(shared), face.fault
    )


class _Loops:
    """Curves in the plane whose axes are as long as the surface is on average."""

    def __init__(self, exact: ExactLoops) -> None:
        self.exact = exact
        self.coedges = [coedge for loop in exact.loops for coedge in loop]
        self.loop_of = [k for k, loop in enumerate(exact.loops) for _ in loop]
        self.first = np.cumsum([0, *map(len, exact.loops)]).tolist()
        some = np.concatenate([c.walk(np.linspace(0.0, 1.0, BRANCH_SAMPLES)) for c in self.coedges])
        _, along_u, along_v = exact.surface.evaluate(some, 1)
        speed = np.stack([np.linalg.norm(along, axis=1) for along in (along_u, along_v)], axis=1)
        self.mean = np.maximum(speed.mean(axis=0), np.finfo(float).tiny)
        slow = np.maximum((speed / self.mean).min(axis=1), SLOWEST)
        slow = slow.reshape(len(self.coedges), -1).min(axis=1)
        self.tolerance = np.array(exact.tolerances) / slow
        self.curves = [self._curve(coedge) for coedge in self.coedges]
        size = diagonal(some * self.mean)
        rounding = 16.0 * float(np.spacing(np.abs(some * self.mean).max()))
        self.near = np.clip(self.tolerance, NEAREST * size, NEAR * size) + rounding

    def _curve(self, coedge: CadCoedge) -> PlaneCurve:
        pieces = 1 if coedge.is_straight else ROUND_PIECES
        if isinstance(coedge.pcurve, BSplineCurve):
            spans = len(np.unique(coedge.pcurve.knots)) - 1
            pieces = min(MOST_PIECES, max(ROUND_PIECES, SPAN_PIECES * spans))
        return PlaneCurve(lambda fraction: coedge.walk(fraction) * self.mean, pieces)

    @cached_property
    def contacts(self) -> list[Contact]:
        """Without those of an edge with itself, and of curves that follow each other."""
        found = contacts(self.curves, self.near)
        return [c for c in found if not self._is_meant(c)][:MOST_CONTACTS]

    @cached_property
    def stray_contacts(self) -> list[Contact]:
        """Contacts that are no common vertex."""
        return [c for c in self.contacts if c.stretch or not self._common_end(c)]

    def fault(self) -> str:
        for contact in self.contacts:
            if contact.stretch:
                return f"{self._names(contact)} lie on each other near {self._place(contact)}"
        for contact in self.contacts:
            depth = self._crossing(contact)
            if depth > 0.0:
                return f"{self._names(contact)} cross at {self._place(contact)}, {depth:.2g} deep"
        return self._encloses_nothing()

    def fault_between(self, face_of: np.ndarray) -> str:
        """Of pieces of one face, by number (loops,): do their loops cross, or lie in each other?"""
        for contact in self.contacts:
            one, other = (face_of[self.loop_of[k]] for k in contact.curves)
            if one != other and self._crossing(contact) > 0.0:
                return f"{self._names(contact)} cross at {self._place(contact)}"
        return ""

    @staticmethod
    def doubled(exact: ExactLoops) -> str:
        """In words, when an edge is walked twice the same way and at the same place."""
        coedges = [coedge for loop in exact.loops for coedge in loop]
        seen: dict[tuple[int, bool], CadCoedge] = {}
        for coedge in coedges:
            other = seen.setdefault((coedge.edge, coedge.reversed), coedge)
            if other is not coedge:
                one, two = (c.uv(np.array([0.3])) for c in (other, coedge))
                extent = np.ptp(coedge.uv(np.linspace(0.0, 1.0, 5)), axis=0).max()
                if np.abs(one - two).max() <= NEAR * extent:
                    return f"its edge {coedge.edge} is walked twice the same way"
        return ""

    def touch(self) -> str:
        """In words, where curves without a common vertex touch."""
        for contact in self.stray_contacts:
            one, other = contact.curves
            if not set(self.exact.ends[one]) & set(self.exact.ends[other]):
                return (
                    f"{self._names(contact)} touch at {self._place(contact)}, where they have no "
                    "common vertex"
                )
        return ""

    def _names(self, contact: Contact) -> str:
        one, other = (self.coedges[k].edge for k in contact.curves)
        return f"its edge {one} and itself" if one == other else f"its edges {one} and {other}"

    def _place(self, contact: Contact) -> str:
        return self._point(contact.curves[0], float(np.mean(contact.fractions[0])))

    def _point(self, curve: int, fraction: float) -> str:
        uv = self.coedges[curve].walk(np.array([fraction]))
        (point,) = self.exact.surface.evaluate(uv, 0)
        noise = ROUNDING * np.abs(point[0]).max()
        return "(" + ", ".join(f"{x if abs(x) > noise else 0.0:.6g}" for x in point[0]) + ")"

    def _is_meant(self, contact: Contact) -> bool:
        """Do the curves meet because they are one edge, or follow each other?"""
        one, other = contact.curves
        if one != other and self.coedges[one].edge == self.coedges[other].edge:
            return True  # a slit, or a seam at a pole
        common = self._common_end(contact)
        if not contact.stretch:
            return common and other in (self._following(one, True), self._following(one, False))
        if not common:
            return False
        whole = any(high - low > 0.99 for low, high in contact.fractions)
        alone = len(self.exact.loops[self.loop_of[one]]) <= 2
        return not whole or alone or (self.exact.shared[one] and self.exact.shared[other])

    def _common_end(self, contact: Contact) -> bool:
        """Does the contact hold a vertex of both curves, or lie next to it?"""
        one, other = contact.curves
        reach = 4.0 * max(self.near[one], self.near[other])
        reach += 2.0 * max(self.tolerance[one], self.tolerance[other])
        for end in (0, 1):
            for end_2 in (0, 1):
                same = self.exact.ends[one][end] == self.exact.ends[other][end_2]
                if same and not (one == other and end == end_2):
                    if self._is_at(one, contact.fractions[0], end, reach) and self._is_at(
                        other, contact.fractions[1], end_2, reach
                    ):
                        return True
                    if one != other and self._stay_together(contact, end, reach):
                        return True
        return False

    def _stay_together(self, contact: Contact, end: int, reach: float) -> bool:
        """Does the first curve stay as near to the other from the contact to its end?"""
        one, other = contact.curves
        t = np.linspace(contact.fractions[0][end], float(end), LOBE_SAMPLES)
        return bool((closest(self.curves[other], self.curves[one].evaluate(t))[1] <= reach).all())

    def _is_at(self, curve: int, fraction: tuple[float, float], end: int, reach: float) -> bool:
        """Is the end of the curve (0 or 1) within reach of its part between two fractions?"""
        at = np.array([fraction[end], float(end)])
        return bool(norm(np.diff(self.curves[curve].evaluate(at), axis=0)) <= reach)

    def _crossing(self, contact: Contact) -> float:
        """How deep the curves cross there, in model units; 0 where they do not, or hardly."""
        if not self._is_crossing(contact):
            return 0.0
        one, other = contact.curves
        deep = DEEP * max(self.tolerance[one], self.tolerance[other], self.near.max())
        depth = min(
            self._lobe(contact, place, forward) for place in (0, 1) for forward in (False, True)
        )
        return depth if depth > deep else 0.0

    def _is_crossing(self, contact: Contact) -> bool:
        """Do the two branches of the one curve lie on both sides of those of the other?"""
        one, other = contact.curves
        first, second = (
            self.curves[curve].evaluate(np.mean(fraction, keepdims=True))[0]
            for curve, fraction in zip(contact.curves, contact.fractions)
        )
        centre = 0.5 * (first + second)
        near = max(self.near[one], self.near[other])
        radius = max(16.0 * near, 4.0 * self.tolerance[one], 4.0 * self.tolerance[other])
        for _ in range(MOST_RADII // len(DOUBLINGS)):
            radii = radius * DOUBLINGS
            branches = np.array([
                self._branch(contact, place, forward, centre, radii)
                for place in (0, 1) for forward in (False, True)
            ])  # fmt: skip
            for ways in (branches - centre).transpose(1, 0, 2):
                if np.isnan(ways).any():
                    return False
                apart = np.linalg.norm(ways[:2, None] - ways[None, 2:], axis=2).min()
                if apart > 8.0 * near:
                    angle = np.arctan2(ways[:, 1], ways[:, 0])
                    turn = np.mod(angle - angle[0], 2.0 * np.pi)
                    return bool((turn[2] < turn[1]) != (turn[3] < turn[1]))
            radius = 2.0 * float(radii[-1])
        return False

    def _branch(
        self, contact: Contact, place: int, forward: bool, centre: np.ndarray, radii: np.ndarray
    ) -> np.ndarray:
        """Where a branch of a loop, on from the contact, is first so far (r,) from it: (r, 2), nan
        where it is nowhere."""
        curve, fraction = contact.curves[place], contact.fractions[place][int(forward)]
        found = np.full((len(radii), 2), np.nan)
        for _ in range(len(self.exact.loops[self.loop_of[curve]]) + 1):
            left = np.isnan(found[:, 0])
            if not left.any():
                break
            end = 1.0 if forward else 0.0
            enough = NEARLY * self.near[curve]
            found[left] = leaving(self.curves[curve], fraction, end, centre, radii[left], enough)
            curve, fraction = self._following(curve, forward), 1.0 - end
        return found

    def _following(self, curve: int, forward: bool) -> int:
        """The next curve of its loop."""
        first, last = self.first[self.loop_of[curve]], self.first[self.loop_of[curve] + 1]
        return first + (curve - first + (1 if forward else -1)) % (last - first)

    def _lobe(self, contact: Contact, place: int, forward: bool) -> float:
        """How far a branch leaves the other loop before its curve ends or meets that again."""
        curve, other = contact.curves[place], contact.curves[1 - place]
        start, end = contact.fractions[place][int(forward)], float(forward)
        for more in self.contacts:
            for side in (0, 1):
                if (
                    more.curves[side] == curve
                    and self.loop_of[more.curves[1 - side]] == (self.loop_of[other])
                ):
                    at = more.fractions[side][int(not forward)]
                    if (forward and start < at < end) or (not forward and end < at < start):
                        end = at
        if abs(end - start) < 1e-9:
            curve = self._following(curve, forward)
            start, end = (0.0, 1.0) if forward else (1.0, 0.0)
        points = self.curves[curve].evaluate(np.linspace(start, end, LOBE_SAMPLES))
        loop = self.loop_of[other]
        others = [k for k in range(self.first[loop], self.first[loop + 1]) if k != curve]
        if not others:
            return float(np.linalg.norm(points - points[:1], axis=1).max())
        return float(np.min([closest(self.curves[k], points)[1] for k in others], axis=0).max())

    def _encloses_nothing(self) -> str:
        """In words, when the loops leave no inside on their left."""
        rings = [self._polygon(k) for k in range(len(self.exact.loops))]
        areas = np.array([_area(ring) for ring in rings])
        lengths = [np.linalg.norm(ring - np.roll(ring, 1, axis=0), axis=1).sum() for ring in rings]
        flat = np.abs(areas) <= np.maximum(FLAT * np.square(lengths), self._slack() * lengths)
        for number in np.flatnonzero(flat).tolist():
            if not self._is_slit(number) and not self._is_shared(number):
                return f"its loop {number} encloses nothing near {self._corner(number)}"
        real = np.flatnonzero(~flat)
        if not len(real):
            return ""
        whisker = self._outside([rings[k] for k in real])
        if whisker is not None:
            edge, place = self.coedges[whisker].edge, self._point(whisker, 0.5)
            return f"its edge {edge} runs there and back outside of its other edges, at {place}"
        depth = nesting_depth([rings[k] for k in real])
        for number, deep in zip(real.tolist(), depth.tolist()):
            if (areas[number] > 0.0) != (deep % 2 == 0):
                way = "counter-clockwise" if areas[number] > 0.0 else "clockwise"
                return (
                    f"its loop {number} near {self._corner(number)} runs {way} within {deep} "
                    "others: they enclose nothing"
                )
        return ""

    def _outside(self, rings: list[np.ndarray]) -> int | None:
        """A curve that is walked there and back where nothing is inside."""
        half = np.array([0.5])
        by_edge: dict[int, int] = {}
        for number, coedge in enumerate(self.coedges):
            other = by_edge.setdefault(coedge.edge, number)
            if other != number:
                middle, back = self.curves[other].evaluate(half), self.curves[number].evaluate(half)
                reach = 4.0 * max(self.near[number], self.tolerance[number])
                if norm(middle - back) <= reach and not is_inside(rings, middle)[0]:
                    return number
        return None

    def _slack(self) -> np.ndarray:
        """(loops,) how far the edges of each may deviate from their p-curves."""
        return np.maximum.reduceat(np.maximum(self.tolerance, self.near), self.first[:-1])

    def _is_shared(self, loop: int) -> bool:
        """Do neighbours hold every edge of it? Then it is closed without an inside."""
        return all(self.exact.shared[self.first[loop] : self.first[loop + 1]])

    def _polygon(self, loop: int) -> np.ndarray:
        own = range(self.first[loop], self.first[loop + 1])
        return np.concatenate(
            [
                self.curves[k].evaluate(np.linspace(0.0, 1.0, 4 * self.curves[k].pieces + 1)[:-1])
                for k in own
            ]
        )

    def _is_slit(self, loop: int) -> bool:
        """Is every edge of the loop walked there and back?"""
        edges = sorted(coedge.edge for coedge in self.exact.loops[loop])
        return edges[::2] == edges[1::2]

    def _corner(self, loop: int) -> str:
        return self._point(self.first[loop], 0.0)


def _area(ring: np.ndarray) -> float:
    x, y = (ring - ring.mean(axis=0)).T
    return 0.5 * float(product(x, np.roll(y, -1)) - product(y, np.roll(x, -1)))
