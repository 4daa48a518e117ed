"""Numbers of faces, solids and edges as a file has them, which may be anything.

Tables are made by these numbers (names, rows of a report), so that one number of ten digits would
be a table of gigabytes. Numbers below ``DENSE`` are kept as they are; where one is beyond, or below
zero, all of them become 0, 1, 2, ... in their order, and the number goes into the name.
"""

from collections.abc import Mapping
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from surfmesh.result.mesh_groups import MeshGroups
from surfmesh.result.surface_mesh import SurfaceMesh

DENSE = 2_000_000
"""Properties of Nastran are often counted from 1,000,001. A table of so many names has 120 MB."""


def named_faces(
    numbers: NDArray, names: Mapping[int, str], count: int
) -> tuple[NDArray[np.int64], tuple[str, ...], tuple[str, ...]]:
    """Face numbers (m,), names by them, and warnings, for a table of names by number.

    count: of the names where numbers are kept; names from ``DENSE`` on are no face's then.
    """
    used, ranks = np.unique(numbers, return_inverse=True)
    if _dense(used):
        if count > DENSE:
            count = max((number for number in names if number < DENSE), default=-1) + 1
        return numbers, tuple(names.get(face, "") for face in range(count)), ()
    found = tuple(names.get(face) or f"face {face}" for face in used.tolist())
    return ranks.reshape(-1), found, (_renumbered("face", used),)


def with_dense_numbers(mesh: SurfaceMesh) -> SurfaceMesh:
    """The mesh, its faces, solids and edges numbered anew where their numbers are too large."""
    changes: dict = {}
    groups: MeshGroups = mesh.groups
    warnings = list(mesh.warnings)
    used, ranks = np.unique(mesh.face_ids, return_inverse=True)
    if not _dense(used):
        faces = used.tolist()
        changes["face_ids"] = ranks.reshape(-1)
        groups = replace(
            groups,
            face_names=tuple(groups.face_label(face) for face in faces),
            face_colours=tuple(groups.face_colour(face) for face in faces),
            face_kinds=tuple(groups.face_kind(face) for face in faces),
        )
        if mesh.promises is not None and len(mesh.promises) != 1:
            changes["promises"] = mesh.promises[faces]
        warnings.append(_renumbered("face", used))
    if mesh.solid_ids is not None:
        used, ranks = np.unique(mesh.solid_ids, return_inverse=True)
        if not _dense(used[used >= 0]) or (used < -1).any():
            solids = used[used >= 0].tolist()
            rank = np.maximum(ranks.reshape(-1, 2) - int((used < 0).sum()), -1)
            changes["solid_ids"] = rank
            groups = replace(
                groups,
                solid_names=tuple(groups.solid_label(solid) for solid in solids),
                solid_colours=tuple(groups.solid_colour(solid) for solid in solids),
            )
            warnings.append(_renumbered("solid", used))
    if mesh.edge_ids is not None:
        used, ranks = np.unique(mesh.edge_ids, return_inverse=True)
        if not _dense(used):
            changes["edge_ids"] = ranks.reshape(-1)
            names = tuple(groups.edge_label(edge) for edge in used.tolist())
            groups = replace(groups, edge_names=names)
            warnings.append(_renumbered("edge", used))
    if not changes:
        return mesh
    return mesh.replaced(groups=groups, warnings=warnings, **changes)


def _dense(used: NDArray) -> bool:
    """Whether ascending numbers are from 0 to ``DENSE``."""
    return not len(used) or (int(used[0]) >= 0 and int(used[-1]) < DENSE)


def _renumbered(kind: str, used: NDArray) -> str:
    return (
        f"{kind} numbers of the file run from {used[0]} to {used[-1]}: "
        f"they are counted from 0 here, names hold them"
    )
