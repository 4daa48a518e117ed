"""Area and volume of closed solids, kept: thin pins and pipes need more than their chord.

A pin of radius R whose mesh may lie ``chord`` inside loses about 2 chord / R of its volume. Where
a solid has lost too much, the sizes on its curved faces are lowered for the next round.
"""

import math

import numpy as np

from surfmesh.cad.model import CadModel, CadSolid
from surfmesh.sizing.size_limits import SizeLimits
from surfmesh.surface_mesh import SurfaceMesh

TOLERANCE = 5.0
"""Relative error of area and volume that is let pass, over chord / diagonal: 0.5 % by default."""

AIM = 0.8
"""Share of it that smaller sizes aim at."""

SMALLEST_STEP = 0.5
"""Sizes are not lowered by more than this factor in one round."""

IMPROVED = 0.8
"""An error that is not below this times the last one has another cause than the sizes."""

MOST_OF_IT = 0.95
"""The faces that make up this share of the misfit are made finer."""


class Contents:
    """Compares the solids of a model with their meshes, round after round."""

    def __init__(self, model: CadModel, chord: float | None, slope: float) -> None:
        self.model, self.slope = model, slope
        self.tolerance = TOLERANCE * chord / model.diagonal if chord else math.inf
        self.errors: dict[int, float] = {}

    def warnings(self) -> list[str]:
        """A sentence for every solid that is still too far from its area or volume."""
        return [
            f"solid {number} ({self.model.solids[number].name or 'no name'}): area or volume is "
            f"{100.0 * error:.2g} % off, {100.0 * self.tolerance:.2g} % was aimed at"
            for number, error in self.errors.items()
            if error > self.tolerance
        ]

    def wishes(self, mesh: SurfaceMesh) -> dict[int, SizeLimits]:
        """By face the smaller sizes that solids need to keep their area and volume."""
        found: dict[int, SizeLimits] = {}
        if not self.tolerance < 1.0:
            return found
        area, volume, misfit = _by_face(mesh)
        behind = np.full(len(area), -1)
        behind[mesh.face_ids] = mesh.solid_ids[:, 0]
        for number, solid in enumerate(self.model.solids):
            outwards = np.where(behind == number, 1.0, -1.0)
            error = _error(self.model, solid, area, outwards * volume)
            before = self.errors.get(number, math.inf)
            self.errors[number] = error
            if error <= self.tolerance or error > IMPROVED * before:
                continue
            factor = max(SMALLEST_STEP, math.sqrt(AIM * self.tolerance / error))
            faces = [face for shell in solid.shells for face, _ in shell]
            for face in largest_misfits(misfit, faces):
                vertices = np.unique(mesh.triangles[mesh.face_ids == face])
                limit = SizeLimits(
                    mesh.points[vertices], factor * mesh.sizes[vertices], self.slope
                )
                found[face] = limit.joined_with(found.get(face))
        return found


def _by_face(mesh: SurfaceMesh) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """area (f,), volume of the cone from the middle of the model over each face (f,), both of
    the mesh; and about the volume between each face and the mesh (f,)."""
    faces = len(mesh.surfaces)
    corners = mesh.points[mesh.triangles] - mesh.points.mean(axis=0)
    normal = 0.5 * np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    size = np.linalg.norm(normal, axis=1)
    cone = np.einsum("ij,ij->i", corners[:, 0], normal) / 3.0
    area = np.bincount(mesh.face_ids, size, faces)
    volume = np.bincount(mesh.face_ids, cone, faces)
    misfit = np.zeros(faces)
    middle = mesh.uv.mean(axis=1)
    centre = mesh.points[mesh.triangles].mean(axis=1)
    for face in np.unique(mesh.face_ids):
        surface = mesh.surfaces[face]
        if surface.kind != "plane":
            of = np.flatnonzero(mesh.face_ids == face)
            gap = surface.evaluate(middle[of], 0)[0] - centre[of]
            misfit[face] = abs(np.einsum("ij,ij->", gap, normal[of]))
    return area, volume, misfit


def _error(model: CadModel, solid: CadSolid, area: np.ndarray, volume: np.ndarray) -> float:
    """The larger of the relative errors of area and volume; 0 where they cannot be compared."""
    faces = [face for shell in solid.shells for face, _ in shell]
    if not solid.closed or not solid.volume > 0.0 or not area[faces].all():
        return 0.0
    exact = math.fsum(model.faces[face].area for face in faces)
    enclosed = volume[faces].sum()
    return max(abs(enclosed / solid.volume - 1.0), abs(area[faces].sum() / exact - 1.0))


def largest_misfits(misfit: np.ndarray, faces: list[int]) -> list[int]:
    """The faces with most of the misfit."""
    order = sorted(set(faces), key=lambda face: -misfit[face])
    share = np.cumsum(misfit[order])
    if not len(share) or not share[-1] > 0.0:
        return []
    return order[: int(np.searchsorted(share, MOST_OF_IT * share[-1])) + 1]
