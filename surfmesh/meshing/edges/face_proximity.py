"""Near faces of a solid: the distance between them as a local size of both.

face a  -----------------        size across the gap at every point of a,
        ^ gap  ^ gap             measured to the foot on b, or to the edges of b
face b  ------------------
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np

from surfmesh._core.space import PointTree
from surfmesh.cad.model.cad_model import CadFace, CadModel
from surfmesh.cad.model.centres import boundary_polygons, inner_samples
from surfmesh.geometry.differential.projection import closest_point
from surfmesh.geometry.inside_loops import is_inside
from surfmesh.geometry.small_matrices import norm
from surfmesh.meshing.edges.edge_sampling import NARROWEST, SLIVER
from surfmesh.sizing.options.model_sizing import ModelSizing
from surfmesh.sizing.rules.across_gaps import size_across

GRID, PROJECTIONS = 17, 4
"""Points each way on a face that feet are looked for from, and steps to them."""


@dataclass(frozen=True, eq=False)
class AcrossTo:
    """A source: sizes that put triangles across the gap to another face.

    fraction: of the gap; ignored, least: gaps below ``ignored`` ask for nothing, none for less
    than ``least``, model units.
    """

    number: int
    face: CadFace
    fraction: float
    ignored: float
    least: float

    def __call__(self, points: np.ndarray) -> np.ndarray:
        """(n, 3) -> (n,), infinite where the faces touch."""
        guess = self._samples[0][self._tree.nearest(points, 1)[1][:, 0]]
        foot, away, _ = closest_point(self.face.surface, points, guess, PROJECTIONS)
        gap = np.where(is_inside(self._rings, foot), away, np.inf)
        gap = np.minimum(gap, self._edges.nearest(points, 1)[0][:, 0])
        return np.where(gap < self.ignored, np.inf, np.maximum(self.fraction * gap, self.least))

    @cached_property
    def _rings(self) -> list[np.ndarray]:
        return boundary_polygons(self.face)

    @cached_property
    def _samples(self) -> tuple[np.ndarray, np.ndarray]:
        """All over the face: places (n, 2), points (n, 3)."""
        uv = np.concatenate([inner_samples(self.face, GRID), *self._rings])
        return uv, self.face.surface.evaluate(uv, 0)[0]

    @cached_property
    def _tree(self) -> PointTree:
        return PointTree(self._samples[1])

    @cached_property
    def _edges(self) -> PointTree:
        return PointTree(self.face.surface.evaluate(np.concatenate(self._rings), 0)[0])

    @cached_property
    def box(self) -> tuple[np.ndarray, np.ndarray]:
        """Corners (3,), (3,) around the face's samples."""
        _, points = self._samples
        return points.min(axis=0), points.max(axis=0)

    def __getstate__(self) -> dict:
        kept = ("number", "face", "fraction", "ignored", "least")
        return {name: getattr(self, name) for name in kept}

    def __repr__(self) -> str:
        return f"gap to {self.face.label(self.number)}"


def with_face_gaps(model: CadModel, wanted: ModelSizing) -> ModelSizing:
    """With a source for each face of the same solid that may be near, if that is asked for."""
    if not wanted.base.gap_faces:
        return wanted
    fraction = size_across(1.0, wanted.base.gap or 1.0, wanted.base.gradient)
    ignored, least = SLIVER * model.diagonal, NARROWEST * model.diagonal
    across = [AcrossTo(k, face, fraction, ignored, least) for k, face in enumerate(model.faces)]
    corners = [
        {v for c in f.coedges for v in (model.edges[c.edge].start, model.edges[c.edge].end)}
        for f in model.faces
    ]
    faces = dict(wanted.faces)
    for solid in model.solids:
        members = sorted({face for shell in solid.shells for face, _ in shell})
        for number in members:
            own = faces.get(number, wanted.base)
            largest = own.max_size or np.inf
            if isinstance(own.size, float):
                largest = min(largest, own.size)
            near = tuple(
                across[other] for other in members
                if other != number and not corners[number] & corners[other]
                and fraction * _apart(across[number].box, across[other].box) < largest
            )  # fmt: skip
            if near:
                faces[number] = own.replaced(sources=own.sources + near)
    return replace(wanted, faces=faces)


def _apart(one: tuple, other: tuple) -> float:
    """Distance of two boxes."""
    return norm(np.maximum(np.maximum(one[0] - other[1], other[0] - one[1]), 0.0))
