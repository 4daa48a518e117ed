"""Patches of both complexes that coincide: one patch that both share, or the place of a refusal.

The borders of two faces on one surface are edges of both, so they are cut into parts with the
same edges wherever they overlap. Such parts with a point in common are one.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from surfmesh.cad.model.cad_model import AND, CadEdge
from surfmesh.errors import SurfaceError
from surfmesh.geometry.small_matrices import product
from surfmesh.intersection.complex import Origin, Patch
from surfmesh.intersection.contacts import Contacts
from surfmesh.intersection.newton import unit_normals
from surfmesh.intersection.pcurve_fitting import nearest_on_surface
from surfmesh.intersection.regions import Region
from surfmesh.intersection.tracing import place

WELL_WITHIN = 1e-3
"""Of the (u, v) box: nearer to its border nothing is said of a point."""


class Overlaps:
    """coincident: pairs of faces of both sides on one surface. merge: else they are refused."""

    def __init__(
        self, contacts: Contacts, edges: Sequence[CadEdge],
        coincident: Sequence[tuple[int, int]], merge: bool,
    ) -> None:  # fmt: skip
        self.contacts, self.edges, self.merge = contacts, edges, merge
        self.coincident = coincident

    def joined(
        self, first: Sequence[Sequence[Patch]], second: Sequence[Sequence[Patch]]
    ) -> list[Patch]:
        """All parts of the faces of both sides, those that coincide once.

        Raises ``SurfaceError`` where they are to be refused, or their borders are not one.
        """
        ours, theirs = [list(parts) for parts in first], [list(parts) for parts in second]
        for i, j in self.coincident:
            for k, part in enumerate(ours[i]):
                found = self._on_other(part, j)
                if found is not None:
                    uv, point, there = found
                    ours[i][k] = self._merged(part, uv, theirs[j], there, point)
        return [patch for parts in (*ours, *theirs) for patch in parts]

    def _on_other(self, part: Patch, j: int) -> tuple[np.ndarray, np.ndarray, np.ndarray] | None:
        """A place within a part, the point and its place on face j of the other side, in which it
        lies; None where it does not. Raises ``SurfaceError`` where it lies there in part."""
        side = self.contacts.sides[1]
        region = Region(part.face)
        places = region.interior_points()
        best = int(np.argmax(region.distance(places)))
        points = part.face.surface.evaluate(places, 0)[0]
        other = side.whole.patches[j].face.surface
        there, distance = nearest_on_surface(other, points)
        inside = np.array([self.contacts.is_inside(side, j, uv) for uv in there])
        on = inside & (distance <= 10.0 * self.contacts.same)
        sure = (region.distance(places) > WELL_WITHIN) & (side.regions[j].distance(there) > 0.0)
        if on[best] and not on[sure & inside].all():
            off = points[sure & inside & ~on][0]
            raise SurfaceError(
                f"{part.face.surface.name} and {other.name} coincide at {place(points[best])} and "
                f"not at {place(off)}, and no edge lies between: cut one of them there"
            )
        return (places[best], points[best], there[best]) if on[best] else None

    def _merged(
        self, part: Patch, uv: np.ndarray, others: list[Patch], there: np.ndarray,
        point: np.ndarray,
    ) -> Patch:  # fmt: skip
        """A part with what it coincides with, which is taken out of the others."""
        other = next((o for o in others if Region(o.face).inside(there[None])[0]), None)
        names = f"{part.face.surface.name} and "
        names += others[0].face.surface.name if other is None else other.face.surface.name
        if not self.merge:
            raise SurfaceError(
                f"{names} coincide on a patch through {place(point)}: coincident='merge' makes it "
                "one patch of both; or move one of them"
            )
        if other is None or self._border(part) != self._border(other):
            raise SurfaceError(
                f"{names} overlap at {place(point)}, but the border of what they share is not "
                "found; move or change one of them"
            )
        others.remove(other)
        one, two = (
            unit_normals(face.surface, at[None])[0]
            for face, at in ((part.face, uv), (other.face, there))
        )
        against = bool(product(one, two) < 0.0)
        also = tuple(
            Origin(o.source, o.original, o.against != against, o.reversed) for o in other.origins
        )
        called = tuple(dict.fromkeys(
            name for face in (part.face, other.face) for name in (face.names or (face.name,))
            if name
        ))  # fmt: skip
        face = replace(part.face, name=AND.join(called), names=called[1:] and called)
        return replace(part, face=face, also=(*part.also, *also))

    def _border(self, patch: Patch) -> Counter[int]:
        """How often a patch uses each edge, but degenerate ones."""
        return Counter(
            coedge.edge for coedge in patch.face.coedges if not self.edges[coedge.edge].degenerate
        )
