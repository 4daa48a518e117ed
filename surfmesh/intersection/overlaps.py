"""Patches of both complexes that coincide: one patch that both share, or the place of a refusal.

The borders of two faces on one surface are edges of both, so they are cut into parts with the
same edges wherever they overlap. Such parts with a point in common are one.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from surfmesh.cad.healing.origins import AND
from surfmesh.cad.model.cad_model import CadEdge
from surfmesh.errors import SurfaceError
from surfmesh.intersection.complex import Origin, Patch
from surfmesh.intersection.contacts import Contacts
from surfmesh.intersection.newton import unit_normals
from surfmesh.intersection.pcurve_fitting import nearest_on_surface
from surfmesh.intersection.regions import Region
from surfmesh.intersection.tracing import place


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
                if not part.face.loops:
                    continue
                point, uv = self._point(part)
                there, distance = nearest_on_surface(
                    self.contacts.sides[1].whole.patches[j].face.surface, point[None]
                )
                if distance[0] > 10.0 * self.contacts.same:
                    continue
                if not self.contacts.is_inside(self.contacts.sides[1], j, there[0]):
                    continue
                ours[i][k] = self._merged(part, uv, theirs[j], there[0], point)
        return [patch for parts in (*ours, *theirs) for patch in parts]

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
        against = bool(one @ two < 0.0)
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

    def _point(self, patch: Patch) -> tuple[np.ndarray, np.ndarray]:
        """A point within a patch, and its place."""
        uv = Region(patch.face).interior_point()
        return patch.face.surface.evaluate(uv[None], 0)[0][0], uv
