"""Volumes of the meshes of closed solids, against what ``Sizing(volume=)`` asks for.

``sizing/rules/volume_rule.py`` foretells the chord that keeps them; where a mesh still misses
more than was asked for, the rule is told to aim lower, and the model is meshed again.
"""

from collections.abc import Mapping

import numpy as np

from surfmesh.cad.model.cad_model import CadModel
from surfmesh.result.surface_mesh import SurfaceMesh
from surfmesh.sizing.rules.volume_rule import AIM

IMPROVED = 0.9
"""A solid whose error is not below this times that of the last mesh is left as it is: its volume
is missing for another reason than the sizes."""

LARGEST_STEP = 0.25
"""An aim is not lowered by more than this factor at once."""


class VolumeAims:
    """What the volume rule is to aim at for each solid, mesh after mesh."""

    def __init__(self, model: CadModel, asked: float | None) -> None:
        """asked: largest relative error of a volume; None: of no concern."""
        self.model, self.asked = model, asked
        self._errors: dict[int, float] = {}

    def lowered_after(self, mesh: SurfaceMesh, aims: Mapping[int, float]) -> dict[int, float]:
        """Lower aims for the solids that ``mesh`` has not kept the volume of.

        aims: relative errors that it was made with, of the solids that the rule was too coarse for.
        """
        lowered: dict[int, float] = {}
        if self.asked is None:
            return lowered
        for number, error in volume_errors(self.model, mesh).items():
            before = self._errors.get(number, np.inf)
            self._errors[number] = error
            if self.asked < error <= IMPROVED * before:
                step = max(LARGEST_STEP, AIM * self.asked / error)
                lowered[number] = step * aims.get(number, AIM * self.asked)
        return lowered


def volume_errors(model: CadModel, mesh: SurfaceMesh) -> dict[int, float]:
    """Relative errors of the volumes of closed solids, all of whose faces are meshed."""
    faces = len(mesh.surfaces)
    a, b, c = np.moveaxis(mesh.points[mesh.triangles] - mesh.points.mean(axis=0), 1, 0)
    cone = np.bincount(mesh.face_ids, np.einsum("ij,ij->i", a, np.cross(b, c)) / 6.0, faces)
    meshed = np.bincount(mesh.face_ids, minlength=faces) > 0
    behind = np.full(faces, -1)
    assert mesh.solid_ids is not None  # noqa: S101 for mypy: every mesh of a model has them
    behind[mesh.face_ids] = mesh.solid_ids[:, 0]
    found = {}
    for number, solid in enumerate(model.solids):
        own = sorted({face for shell in solid.shells for face, _ in shell})
        if solid.closed and solid.volume > 0.0 and meshed[own].all():
            volume = float((np.where(behind == number, 1.0, -1.0) * cone)[own].sum())
            found[number] = abs(volume / solid.volume - 1.0)
    return found
