"""The loops of a face as curves in its plane of (u, v), and where these come near to each other.

contacts          meant: at a common vertex      stray
  __x__               x___                         __x__
 |     |             |                            |  x  |
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from surfmesh.cad.model.cad_model import CadCoedge
from surfmesh.geometry.boxes import diagonal
from surfmesh.geometry.cad_surfaces.face_surface import FaceSurface
from surfmesh.geometry.cad_surfaces.nurbs import BSplineCurve
from surfmesh.geometry.planar.curve_contacts import Contact, PlaneCurve, closest, contacts
from surfmesh.geometry.small_matrices import norm

ROUND_PIECES, SPAN_PIECES, MOST_PIECES = 16, 4, 256
"""Pieces of conics, of each span of a spline, and at most, in which curves hardly bend."""

NEAR, NEAREST = 1e-6, 1e-10
"""Of the diagonal of the loops in (u, v): how near is a contact, at most and at least; in between
it is the tolerance of the edges."""

SLOWEST = 0.1
"""Least speed, of the mean, that a tolerance is translated to (u, v) with."""

WHOLE = 0.99
"""Fraction of a curve: contacts that are longer are all of it."""

CURVE_SAMPLES = 33
"""Points of a curve that its speed and its extent are known from."""

STRETCH_SAMPLES = 9
"""Points between a contact and a vertex near it."""

MOST_CONTACTS = 200
"""Contacts that are looked at: more are a fault already, or far too many for one face."""

ROUNDING = 1e-12
"""Of a place: smaller coordinates are zero."""


@dataclass(frozen=True, eq=False)
class FaceLoops:
    """The loops of a face."""

    surface: FaceSurface
    loops: tuple[tuple[CadCoedge, ...], ...]
    ends: tuple[tuple[int, int], ...]
    """For each coedge the vertices where its loop enters and leaves it."""
    tolerances: tuple[float, ...]
    shared: tuple[bool, ...]
    """For each coedge: another face uses its edge too."""

    @property
    def coedges(self) -> list[CadCoedge]:
        return [coedge for loop in self.loops for coedge in loop]


class LoopCurves:
    """Curves in the plane whose axes are as long as the surface is on average."""

    def __init__(self, of_face: FaceLoops) -> None:
        self.of_face, self.coedges = of_face, of_face.coedges
        self.loop_of = [k for k, loop in enumerate(of_face.loops) for _ in loop]
        self.first = np.cumsum([0, *map(len, of_face.loops)]).tolist()
        some = np.concatenate([c.walk(np.linspace(0.0, 1.0, CURVE_SAMPLES)) for c in self.coedges])
        _, along_u, along_v = of_face.surface.evaluate(some, 1)
        speed = np.stack([np.linalg.norm(along, axis=1) for along in (along_u, along_v)], axis=1)
        self.mean = np.maximum(speed.mean(axis=0), np.finfo(float).tiny)
        slow = np.maximum((speed / self.mean).min(axis=1), SLOWEST)
        slow = slow.reshape(len(self.coedges), -1).min(axis=1)
        self.tolerance = np.array(of_face.tolerances) / slow
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

    def following(self, curve: int, forward: bool) -> int:
        """The next curve of its loop."""
        first, last = self.first[self.loop_of[curve]], self.first[self.loop_of[curve] + 1]
        return first + (curve - first + (1 if forward else -1)) % (last - first)

    def of_loop(self, loop: int) -> range:
        """The curves of a loop, by number."""
        return range(self.first[loop], self.first[loop + 1])

    def point(self, curve: int, fraction: float) -> str:
        """In words."""
        uv = self.coedges[curve].walk(np.array([fraction]))
        (point,) = self.of_face.surface.evaluate(uv, 0)
        noise = ROUNDING * np.abs(point[0]).max()
        return "(" + ", ".join(f"{x if abs(x) > noise else 0.0:.6g}" for x in point[0]) + ")"

    def _is_meant(self, contact: Contact) -> bool:
        """Do the curves meet because they are one edge, or follow each other?"""
        one, other = contact.curves
        if one != other and self.coedges[one].edge == self.coedges[other].edge:
            return True  # a slit, or a seam at a pole
        common = self._common_end(contact)
        if not contact.stretch:
            return common and other in (self.following(one, True), self.following(one, False))
        if not common:
            return False
        whole = any(high - low > WHOLE for low, high in contact.fractions)
        alone = len(self.of_face.loops[self.loop_of[one]]) <= 2
        return not whole or alone or (self.of_face.shared[one] and self.of_face.shared[other])

    def _common_end(self, contact: Contact) -> bool:
        """Does the contact hold a vertex of both curves, or lie next to it?"""
        one, other = contact.curves
        reach = 4.0 * max(self.near[one], self.near[other])
        reach += 2.0 * max(self.tolerance[one], self.tolerance[other])
        for end in (0, 1):
            for end_2 in (0, 1):
                same = self.of_face.ends[one][end] == self.of_face.ends[other][end_2]
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
        t = np.linspace(contact.fractions[0][end], float(end), STRETCH_SAMPLES)
        return bool((closest(self.curves[other], self.curves[one].evaluate(t))[1] <= reach).all())

    def _is_at(self, curve: int, fraction: tuple[float, float], end: int, reach: float) -> bool:
        """Is the end of the curve (0 or 1) within reach of its part between two fractions?"""
        at = np.array([fraction[end], float(end)])
        return bool(norm(np.diff(self.curves[curve].evaluate(at), axis=0)) <= reach)
