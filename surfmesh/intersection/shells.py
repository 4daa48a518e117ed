"""Faces that enclose bodies: shells by common edges, solids by which shell lies in which."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from surfmesh.cad.model.cad_model import CadEdge, CadFace, CadSolid, Shell
from surfmesh.cad.model.invariants import is_closed
from surfmesh.errors import SurfaceError
from surfmesh.geometry.components import components
from surfmesh.intersection.insides import Body
from surfmesh.intersection.regions import Region


def shells_of(
    faces: Sequence[CadFace], edges: Sequence[CadEdge], against: Sequence[bool]
) -> list[Shell]:
    """Faces joined by their edges. Raises ``SurfaceError`` for a shell that is not closed."""
    users: dict[int, list[int]] = {}
    for number, face in enumerate(faces):
        for coedge in face.coedges:
            if not edges[coedge.edge].degenerate:
                users.setdefault(coedge.edge, []).append(number)
    pairs = np.array([(own[0], k) for own in users.values() for k in own[1:]], np.int64)
    label = components(len(faces), pairs.reshape(-1, 2))
    shells = []
    for root in np.unique(label):
        shell = tuple((k, bool(against[k])) for k in np.flatnonzero(label == root).tolist())
        if not is_closed(faces, [shell], edges):
            raise SurfaceError(
                "what is kept does not close: the inputs touch along an edge or a patch, which "
                "only exactly transversal ones may"
            )
        shells.append(shell)
    return shells


def solids_of(
    faces: Sequence[CadFace], edges: Sequence[CadEdge], shells: Sequence[Shell],
    cones: Sequence[float], size: float, name: str,
) -> list[CadSolid]:  # fmt: skip
    """Shells with a positive volume are bodies, negative ones voids in the smallest around them.

    cones: of each face the signed volume between it and one common point, outside counted.
    """
    volumes = [float(sum(cones[face] for face, _ in shell)) for shell in shells]
    bodies = [k for k, volume in enumerate(volumes) if volume > 0.0]
    held: dict[int, list[Shell]] = {k: [shells[k]] for k in bodies}
    total = dict((k, volumes[k]) for k in bodies)
    for k, volume in enumerate(volumes):
        if volume > 0.0:
            continue
        face = faces[shells[k][0][0]]
        point = face.surface.evaluate(Region(face).interior_point()[None], 0)[0][0]
        around = [
            b for b in bodies
            if Body([faces[f] for f, _ in shells[b]], size, name).holds(point)
        ]  # fmt: skip
        if not around:
            raise SurfaceError("a void of what is kept lies in no body")
        smallest = min(around, key=lambda b: volumes[b])
        held[smallest].append(shells[k])
        total[smallest] += volume
    return [CadSolid(tuple(held[k]), "", None, total[k], closed=True) for k in bodies]
