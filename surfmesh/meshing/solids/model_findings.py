"""What the user should know of the mesh of a CAD model: findings, and the sentences made of them.

face_findings   faces that are missing, or lie off their surfaces
loose_edges     edges whose faces are farther apart than the chord error
not_refined     faces that still ask for smaller sizes
"""

from collections.abc import Sequence

from surfmesh.cad.model.cad_model import CadModel
from surfmesh.errors import MeshingError
from surfmesh.meshing.faces.face_state import FaceState
from surfmesh.meshing.patch.refinement_loop import MAX_ROUNDS
from surfmesh.result.findings import Finding, FindingKind
from surfmesh.sizing.options.sizing import Sizing

SHOWN = 5
"""Faces that are named in one sentence."""


def require_all_read(model: CadModel) -> None:
    """Raises ``MeshingError`` that names what was left out when the model was read."""
    if model.left_out:
        raise MeshingError(
            f"{(model.name or model.source)!r} cannot be meshed in full: "
            f"{_some(model.left_out)}. Repair it, or use strict=False (--no-strict) to get the "
            "other faces"
        )


def require_all_meshed(model: CadModel, faces: list[FaceState]) -> None:
    """Raises ``MeshingError`` that names the faces that could not be meshed, with the reasons."""
    failed = [state.reason for state in faces if state.mesh.failure]
    if failed:
        cure = "Lower the sizes, repair" if any(s.may_be_forced for s in faces) else "Repair"
        raise MeshingError(
            f"{len(failed)} of {len(faces)} faces of {model.name or model.source!r} could not be "
            f"meshed: {_some(failed)}. {cure} the faces, or use strict=False to get the others"
        )


def face_findings(faces: list[FaceState], left_out: Sequence[str] = ()) -> list[Finding]:
    """What was left out when the model was read, then failures, then what lies off its surface."""
    missing, off = FindingKind.NOT_MESHED, FindingKind.OFF_SURFACE
    found = [Finding(missing, sentence) for sentence in left_out]
    found += [
        Finding(missing, state.mesh.failure, state.number, state.label, state.mesh.place)
        for state in faces
        if state.mesh.failure
    ]
    return found + [
        Finding(off, state.mesh.remark, state.number, state.label)
        for state in faces
        if state.mesh.remark
    ]


def not_refined(faces: list[FaceState]) -> list[str]:
    """What is said of faces that would need another round."""
    if not faces:
        return []
    names = [state.label.removeprefix("face ") for state in faces]
    more = f" and {len(names) - SHOWN} more" if len(names) > SHOWN else ""
    return [
        f"smaller sizes, tried in up to {MAX_ROUNDS} rounds, have not sufficed on "
        f"face{'s' if len(names) > 1 else ''} {', '.join(names[:SHOWN])}{more}"
    ]


def loose_edges(model: CadModel, sizing: Sizing) -> list[str]:
    """A sentence on edges whose faces are farther apart than the chord error asked for."""
    if sizing.chord is None:
        return []
    real = [k for k, edge in enumerate(model.edges) if edge.curve is not None]
    loose = [k for k in real if model.edges[k].tolerance > sizing.chord]
    if not loose:
        return []
    worst = max(loose, key=lambda k: model.edges[k].tolerance)
    return [
        f"{len(loose)} edge{'s' if len(loose) > 1 else ''} may lie farther off the faces than the "
        f"chord error of {sizing.chord:.3g}, and the mesh with them; the tolerance of edge {worst} "
        f"is {model.edges[worst].tolerance:.3g} {model.unit}"
    ]


def _some(sentences: Sequence[str]) -> str:
    """The first few, and how many more there are."""
    more = len(sentences) - SHOWN
    return "; ".join(sentences[:SHOWN]) + (f"; and {more} more" if more > 0 else "")
