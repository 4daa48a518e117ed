"""On which side of each other input a patch lies."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from surfmesh.cad.model.cad_model import CadCoedge, CadModel
from surfmesh.errors import SurfaceError
from surfmesh.geometry.differential.projection import closest_point
from surfmesh.geometry.small_matrices import norm, product
from surfmesh.intersection.complex import Complex, Patch
from surfmesh.intersection.insides import Body
from surfmesh.intersection.newton import unit_normals
from surfmesh.intersection.regions import Region

MIDDLE = np.array([0.47])
"""Of a common curve: where the side is seen."""

TANGENT = 1e-6
"""Sine: a patch that leaves a curve so near to a surface does not tell its side there."""

GRID = 33
"""Samples each way of a face, of which the nearest to a point is looked for first."""


class Signs:
    """Of all patches of a complex, found when asked for."""

    def __init__(
        self, whole: Complex, models: Sequence[CadModel], bodies: Sequence[Body | None],
        size: float,
    ) -> None:  # fmt: skip
        self.whole, self.models, self.bodies, self.size = whole, models, bodies, size
        self.users: dict[int, list[tuple[int, CadCoedge]]] = {}
        for number, patch in enumerate(whole.patches):
            for coedge in patch.face.coedges:
                self.users.setdefault(coedge.edge, []).append((number, coedge))
        self._known: dict[int, dict[int, int]] = {}
        self._open: dict[int, list[int]] = {}
        self.reasons: dict[tuple[int, int], str] = {}
        """Why it is not known on which side of a closed input a patch lies."""
        self._points: dict[int, np.ndarray] = {}

    def of(self, patch: Patch) -> dict[int, int]:
        """By the number of each other input: +1, -1; 0 where the patch lies on both sides."""
        number = next(k for k, other in enumerate(self.whole.patches) if other is patch)
        if number not in self._known:
            self._known[number] = {
                other: self._sign(number, other)
                for other in range(len(self.models))
                if not patch.is_of(other)
            }
        return self._known[number]

    def _sign(self, number: int, other: int) -> int:
        body = self.bodies[other]
        if body is not None:
            try:
                return -1 if body.holds(self._point(number)) else 1
            except SurfaceError as error:  # said where somebody needs it
                self.reasons[(number, other)] = str(error)
                return 0
        if other not in self._open:
            self._open[other] = self._beside(other)
        return self._open[other][number]

    def _point(self, number: int) -> np.ndarray:
        """A point within a patch."""
        if number not in self._points:
            face = self.whole.patches[number].face
            uv = Region(face).interior_point()
            self._points[number] = face.surface.evaluate(uv[None], 0)[0][0]
        return self._points[number]

    def _beside(self, other: int) -> list[int]:
        """Of all patches, the sides of an open input."""
        count = len(self.whole.patches)
        seen: list[set[int]] = [set() for _ in range(count)]
        neighbours: list[set[int]] = [set() for _ in range(count)]
        for users in self.users.values():
            cutting = [user for user in users if self.whole.patches[user[0]].is_of(other)]
            own = [user for user in users if not self.whole.patches[user[0]].is_of(other)]
            for number, coedge in own:
                if cutting:
                    seen[number] |= {
                        sign for user in cutting
                        if (sign := self._at_curve(number, coedge, *user))
                    }  # fmt: skip
            if not cutting:
                for one, _ in own:
                    for two, _ in own:
                        same = self.whole.patches[two].is_of(self.whole.patches[one].source)
                        if one != two and same:
                            neighbours[one].add(two)
        signs = [next(iter(s)) if len(s) == 1 else 0 for s in seen]
        front = [k for k in range(count) if signs[k]]
        for k in front:
            for near in neighbours[k]:
                if not seen[near] and not signs[near]:
                    signs[near] = signs[k]
                    front.append(near)
        for k in range(count):
            if not seen[k] and not signs[k] and not self.whole.patches[k].is_of(other):
                signs[k] = self._at_nearest(k, other)
        return signs

    def _at_curve(self, number: int, coedge: CadCoedge, other: int, cut: CadCoedge) -> int:
        """Seen on a common curve: where the inside of a patch, on the left of its coedge, lies; 0
        where it is tangent there."""
        patch, across = self.whole.patches[number], self.whole.patches[other]
        edge = self.whole.edges[coedge.edge]
        tangent = edge.evaluate(MIDDLE, 1)[1]
        if coedge.reversed:
            tangent = -tangent
        left = np.cross(unit_normals(patch.face.surface, coedge.uv(MIDDLE)), tangent)
        normal = unit_normals(across.face.surface, cut.uv(MIDDLE))
        if across.face.reversed:
            normal = -normal
        up = float(np.einsum("ij,ij->", left, normal)) / norm(tangent)
        return 0 if abs(up) < TANGENT else 1 if up > 0.0 else -1

    def _at_nearest(self, number: int, other: int) -> int:
        """By the normal at the nearest point of an input that the patch does not meet."""
        point = self._point(number)
        line = np.linspace(0.0, 1.0, GRID)
        grid = np.stack(np.meshgrid(line, line), axis=-1).reshape(-1, 2)
        best, nearest = 0, np.inf
        for face in self.models[other].faces:
            box = np.array(face.surface.domain)
            uv = box[:, 0] + grid * (box[:, 1] - box[:, 0])
            uv = uv[Region(face).inside(uv)]
            if not len(uv):
                continue
            away = np.linalg.norm(face.surface.evaluate(uv, 0)[0] - point, axis=1)
            guess = uv[int(np.argmin(away))][None]
            foot, distance, place = closest_point(face.surface, point[None], guess, 8, 0.0)
            if distance[0] < nearest:
                nearest = float(distance[0])
                normal = unit_normals(face.surface, foot)[0]
                up = float(product(point - place[0], normal)) * (-1.0 if face.reversed else 1.0)
                best = 1 if up > 0.0 else -1
        return best
