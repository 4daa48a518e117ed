"""Volumes of solids against what ``Sizing(volume=)`` asked for."""

from __future__ import annotations

import numpy as np

from surfmesh.geometry.surface import surface_kind
from surfmesh.quality.measures.by_solid import SolidRow
from surfmesh.result.surface_mesh import SurfaceMesh


def volumes_not_kept(
    mesh: SurfaceMesh, solids: tuple[SolidRow, ...]
) -> tuple[list[str], list[str]]:
    """Sentences for solids whose volume is farther off than was asked for: problems, and those
    that a ``min_size`` of the user's forbids. The error grows with the square of the size."""
    asked = getattr(mesh.sizing, "volume", None)
    if asked is None:
        return [], []
    least = getattr(mesh.sizing, "min_size", None) or 0.0
    broken, forbidden = [], []
    for row in solids:
        if row.volume is None or not row.volume_exact:
            continue
        error = abs(row.volume / row.volume_exact - 1.0)
        if error <= asked:
            continue
        called = f"solid {row.solid}" + (f" ({row.name})" if row.name else "")
        if _curved_size(mesh, row.solid) * np.sqrt(asked / error) < least:
            forbidden.append(
                f"min_size {least:g} keeps {called} from the volume {asked:g}: it is {error:.3g} "
                "off"
            )
        else:
            broken.append(f"the volume of {called} is {error:.3g} off, {asked:g} was asked for")
    return broken, forbidden


def _curved_size(mesh: SurfaceMesh, solid: int) -> float:
    """Mean wanted size on the curved faces of a solid; infinite where nothing is known."""
    if mesh.sizes is None or mesh.solid_ids is None or not mesh.surfaces:
        return np.inf
    curved = np.array([surface_kind(surface) != "plane" for surface in mesh.surfaces])
    of = (mesh.solid_ids == solid).any(axis=1) & curved[mesh.face_ids]
    return float(mesh.sizes[mesh.triangles[of]].mean()) if of.any() else np.inf
