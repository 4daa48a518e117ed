"""What of surfaces that cut each other is kept, and the solids that it encloses.

    all                                everything, as a complex of faces
    union, difference, common          of closed inputs, as closed solids
    {name: side, ...}                  of each input the parts on one side: "+other", "-other",
                                       a point (3,) for the part that is nearest to it

Against a closed input + is outside and - inside, by rays. Against an open one + is where its
normal r_u x r_v points: beside a common curve that is seen on the curve; a part that has none
takes it from its neighbours on the same input, else from the nearest point.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np

from surfmesh.cad.model.cad_model import CadEdge, CadFace, CadModel, CadSolid, CadVertex
from surfmesh.errors import SurfaceError, shown
from surfmesh.intersection.complex import Complex, Origin, Patch
from surfmesh.intersection.contents import region_cone
from surfmesh.intersection.insides import Body
from surfmesh.intersection.regions import Region
from surfmesh.intersection.shells import shells_of, solids_of
from surfmesh.intersection.signs import Signs

WHOLE = ("all", "union", "difference", "common")


class Keeping:
    """keep: see above. names, models: of the inputs; size: the diagonal of all."""

    def __init__(
        self, keep: Any, names: Sequence[str], models: Sequence[CadModel], size: float
    ) -> None:
        self.names, self.models, self.size = list(names), models, size
        self.bodies = [Body.of(model, size) for model in models]
        self.what = keep if isinstance(keep, str) else "sides"
        self.wanted: dict[int, list[Any]] = {}
        self.signs: Signs | None = None
        if isinstance(keep, str):
            self._check_word(keep)
        elif isinstance(keep, Mapping):
            self.wanted = {self._number(key): _listed(side) for key, side in keep.items()}
            for sides in self.wanted.values():
                for side in sides:
                    self._check_side(side)
        else:
            raise SurfaceError(f"keep={shown(keep)}: one of {', '.join(WHOLE)}, or a mapping")

    def _check_word(self, keep: str) -> None:
        if keep not in WHOLE:
            raise SurfaceError(f"keep={shown(keep)}: one of {', '.join(WHOLE)}, or a mapping")
        if keep == "all":
            return
        for name, body in zip(self.names, self.bodies):
            if body is None:
                raise SurfaceError(
                    f"keep={keep!r} is for closed inputs, and {name} is not closed; keep sides "
                    "instead, by a mapping"
                )

    def _check_side(self, side: Any) -> None:
        if isinstance(side, str):
            if side not in ("all", "none"):
                self._signed(side)
        elif not _is_point(side):
            raise SurfaceError(
                f"keep: {shown(side)} is no side: '+other', '-other', 'all', 'none' or a point"
            )

    def _number(self, key: Any) -> int:
        if isinstance(key, int) and 0 <= key < len(self.names):
            return key
        if key in self.names:
            return self.names.index(key)
        raise SurfaceError(f"keep: there is no {shown(key)} among {', '.join(self.names)}")

    def _signed(self, side: str) -> tuple[int, int]:
        """The other input, and +1 or -1."""
        sign, name = side[:1], side[1:].strip()
        if sign not in ("+", "-"):
            raise SurfaceError(f"keep: {side!r} is no side: '+other', '-other', 'all' or 'none'")
        return self._number(int(name) if name.isdigit() else name), 1 if sign == "+" else -1

    def kept(self, whole: Complex) -> list[tuple[Patch, bool]]:
        """The patches that are kept; with each whether outside is against its normal."""
        self.signs = Signs(whole, self.models, self.bodies, self.size)
        patches = list(whole.patches)
        if self.what in ("all", "sides"):
            if self.what == "sides":
                patches = [patch for patch in patches if self._is_wanted(patch, patches)]
            kept = [(patch, False) for patch in patches]
        else:
            turned = [(patch, self._outside_against(patch)) for patch in patches]
            kept = [(patch, against) for patch, against in turned if against is not None]
        if not kept:
            raise SurfaceError("nothing is left of what is to be kept")
        return kept

    def sides(self, patch: Patch) -> dict[int, int]:
        """On which side of each other input a patch lies: +1, -1, or 0 where that is not known."""
        assert self.signs is not None  # noqa: S101  asked after ``kept``
        return self.signs.of(patch)

    def solids(
        self, faces: Sequence[CadFace], edges: Sequence[CadEdge], vertices: Sequence[CadVertex],
        against: Sequence[bool],
    ) -> list[CadSolid]:  # fmt: skip
        """The bodies that the kept faces enclose; none where everything or sides are kept."""
        if self.what in ("all", "sides"):
            return []
        origin = vertices[0].point
        cones = [
            (-1.0 if face.reversed ^ turned else 1.0)
            * region_cone(face.surface, face.loops, origin)
            for face, turned in zip(faces, against)
        ]
        shells = shells_of(faces, edges, against)
        return solids_of(faces, edges, shells, cones, self.size, self.what)

    def _outside_against(self, patch: Patch) -> bool | None:
        """Of a patch that separates what is kept from what is not, whether the outside is against
        its normal; None of one that does not."""
        sides = self.sides(patch)
        if self.signs is not None and not all(sides.values()):
            raise SurfaceError(next(iter(self.signs.reasons.values())))
        front = {other: sign < 0 for other, sign in sides.items()}
        back = dict(front)
        for origin in patch.origins:
            ahead, behind = self._inside_beside(origin)
            if origin.source in front:  # of two of its faces
                ahead, behind = ahead or front[origin.source], behind or back[origin.source]
            front[origin.source], back[origin.source] = ahead, behind
        ahead, behind = self._holds(front), self._holds(back)
        return None if ahead == behind else ahead != patch.face.reversed

    def _inside_beside(self, origin: Origin) -> tuple[bool, bool]:
        """Is it inside of an input on the side that r_u x r_v of a patch points to, and on the
        other? Both, of a face between two of its solids."""
        ahead = behind = False
        for solid in self.models[origin.source].solids:
            for shell in solid.shells:
                for face, against in shell:
                    if face == origin.original:
                        outwards = against == origin.reversed  # along its own r_u x r_v
                        if outwards == origin.against:
                            ahead = True
                        else:
                            behind = True
        return ahead, behind

    def _holds(self, inside: Mapping[int, bool]) -> bool:
        """Is a place kept that lies inside of these inputs?"""
        if self.what == "common":
            return all(inside.values())
        if self.what == "union":
            return any(inside.values())
        return inside[0] and not any(held for k, held in inside.items() if k)

    def _is_wanted(self, patch: Patch, patches: Sequence[Patch]) -> bool:
        """Is a patch kept for the sake of one of its inputs?"""
        sources = {origin.source for origin in patch.origins}
        return any(self._is_wanted_of(patch, source, patches) for source in sources)

    def _is_wanted_of(self, patch: Patch, source: int, patches: Sequence[Patch]) -> bool:
        for side in self.wanted.get(source, ["all"]):
            if isinstance(side, str):
                if side == "all":
                    continue
                if side == "none":
                    return False
                other, sign = self._signed(side)
                if self.sides(patch).get(other) != sign:
                    return False
            elif patch is not _nearest(patches, source, np.asarray(side, float)):
                return False
        return True


def _listed(side: Any) -> list[Any]:
    if isinstance(side, (list, tuple)) and not _is_point(side):
        return list(side)
    return [side]


def _is_point(side: Any) -> bool:
    try:
        point = np.asarray(side, float)
    except (TypeError, ValueError):
        return False
    return point.shape == (3,) and bool(np.isfinite(point).all())


def _nearest(patches: Sequence[Patch], source: int, point: np.ndarray) -> Patch:
    """The part of an input that is nearest to a point, by samples within it."""
    best, nearest = None, np.inf
    line = (np.arange(64) + 0.5) / 64
    grid = np.stack(np.meshgrid(line, line), axis=-1).reshape(-1, 2)
    for patch in patches:
        if not patch.is_of(source):
            continue
        box = np.array(patch.face.surface.domain)
        region = Region(patch.face)
        uv = box[:, 0] + grid * (box[:, 1] - box[:, 0])
        uv = np.concatenate([uv[region.inside(uv)], region.interior_point()[None]])
        distance = np.linalg.norm(patch.face.surface.evaluate(uv, 0)[0] - point, axis=1).min()
        if distance < nearest:
            best, nearest = patch, float(distance)
    assert best is not None  # noqa: S101  every input has a patch
    return best
