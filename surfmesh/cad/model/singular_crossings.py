"""Where faces and their edges cross lines that are one point in space."""

from __future__ import annotations

import numpy as np

from surfmesh.cad.model.cad_model import CadCoedge, CadFace
from surfmesh.cad.model.invariants import ENDS, FRACTIONS
from surfmesh.cad.model.loops import Loop
from surfmesh.geometry.cad_surfaces.singular_lines import SingularLine, singular_lines

ON_LINE = 1e-7  # of the face's box: a p-curve that ends so near a line ends on it
SAMPLES = 65  # of a p-curve, between which it is looked for crossings
HALVINGS = 60


def lines_of(face: CadFace) -> list[SingularLine]:
    """Lines that run through the face, or along its rim where its p-curve jumps."""
    if face.kind in ("plane", "cylinder", "extrusion"):
        return []
    return [
        line for line in singular_lines(face.surface)
        if _crosses(face, line) or any(jumps(face, line, loop) for loop in face.loops)
    ]  # fmt: skip


def slack_of(face: CadFace, axis: int) -> float:
    low, high = face.surface.domain[axis]
    return ON_LINE * (high - low)


def _crosses(face: CadFace, line: SingularLine) -> bool:
    """Does the face lie on both sides of the line?"""
    uv = np.concatenate([coedge.uv(FRACTIONS) for coedge in face.coedges])
    beside = uv[:, line.axis] - line.value
    slack = slack_of(face, line.axis)
    return bool((beside < -slack).any() and (beside > slack).any())


def jumps(face: CadFace, line: SingularLine, loop: Loop) -> bool:
    """Does a p-curve end on the line, and the next one begin elsewhere on it?"""
    return any(jumps_between(face, line, one, loop[k - 1]) for k, one in enumerate(loop))


def jumps_between(face: CadFace, line: SingularLine, after: CadCoedge, here: CadCoedge) -> bool:
    leaves, enters = here.walk(ENDS[1:])[0], after.walk(ENDS[:1])[0]
    on = np.abs(np.array([leaves, enters])[:, line.axis] - line.value)
    across = 1 - line.axis
    step = abs(leaves[across] - enters[across])
    return bool((on <= slack_of(face, line.axis)).all() and step > slack_of(face, across))


def crossings(coedge: CadCoedge, line: SingularLine, slack: float) -> list[float]:
    """Fractions of the edge's range, 0 and 1 excluded, at which its p-curve crosses the line."""
    straight = coedge.is_straight
    fraction = np.linspace(0.0, 1.0, 2 if straight else SAMPLES)
    beside = coedge.uv(fraction)[:, line.axis] - line.value
    beside[np.abs(beside) <= slack] = 0.0
    found = [float(fraction[k]) for k in np.flatnonzero(beside == 0.0) if 0 < k < len(fraction) - 1]
    if len(found) > 2:  # it runs along the line
        return []
    for k in np.flatnonzero(beside[1:] * beside[:-1] < 0.0):
        low, high = float(fraction[k]), float(fraction[k + 1])
        if straight:
            found.append(low + (high - low) * float(beside[k] / (beside[k] - beside[k + 1])))
            continue
        for _ in range(HALVINGS):
            middle = 0.5 * (low + high)
            here = coedge.uv(np.array([middle]))[0, line.axis] - line.value
            low, high = (middle, high) if here * beside[k] > 0.0 else (low, middle)
        found.append(0.5 * (low + high))
    return sorted(found)
