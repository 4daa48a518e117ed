"""What is proved of a mesh: how far it and its surfaces are apart at most, and its topology."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from surfmesh.quality.measures.measurements import Measurements
from surfmesh.quality.measures.places import Point, as_point, face_in_words
from surfmesh.quality.measures.proof import Proof
from surfmesh.quality.measures.proved_topology import Answer

NAMED = 20  # faces


@dataclass(frozen=True, kw_only=True)
class NotProved:
    """A face some of whose triangles are not proved."""

    face: int
    name: str
    triangles: int  # of it, that are not
    of: int  # of it, in all
    bound: float  # the largest, model units; infinite where there is none
    because: str
    point: Point  # the middle of the triangle with the largest bound

    def __str__(self) -> str:
        return (
            f"{face_in_words(self.face, self.name)}: {self.triangles} of {self.of}, {self.because}"
        )


@dataclass(frozen=True, kw_only=True)
class ProofFigures:
    """Distances in model units, both ways, round-off included. docs/proof.md is the statement."""

    proved: int  # triangles that are within the chord, or have a bound where none was asked for
    proved_share: float  # of all triangles
    bound_max: float  # the largest bound of all; infinite where one has none
    bound_over_sampled: float | None  # median, of the triangles that lie far enough to compare
    not_proved: tuple[NotProved, ...]  # the first twenty faces
    edges_bound_max: float | None  # of segments of CAD edges and their curves; None: there are none
    edges_without_bound: int  # segments
    homeomorphic: Answer  # mesh and surface, or model
    isotopic: Answer  # by a deformation of space

    @classmethod
    def of(cls, measured: Measurements) -> ProofFigures | None:
        """None where no surface is known, or the mesh is not finite."""
        found = measured.proof
        if found is None:
            return None
        proved, finite = found.is_proved, np.isfinite(found.edge_bound)
        return cls(
            proved=int(np.count_nonzero(proved)),
            proved_share=float(np.mean(proved)),
            bound_max=float(found.bound.max()),
            bound_over_sampled=found.over_sampled,
            not_proved=_not_proved(measured, found),
            edges_bound_max=float(found.edge_bound[finite].max()) if finite.any() else None,
            edges_without_bound=int(np.count_nonzero(~finite)),
            homeomorphic=measured.homeomorphic,
            isotopic=measured.isotopic,
        )


def _not_proved(measured: Measurements, found: Proof) -> tuple[NotProved, ...]:
    """The faces with the most first."""
    mesh, left = measured.mesh, ~found.is_proved
    count = np.bincount(mesh.face_ids[left])
    faces = np.flatnonzero(count)
    faces = faces[np.argsort(-count[faces], kind="stable")][:NAMED]
    rows = []
    for face in faces.tolist():
        members = np.flatnonzero(mesh.face_ids == face)
        worst = members[np.argmax(found.bound[members])]
        most = float(found.bound[worst])
        because = f"the largest bound is {most:.4g}"
        if face in found.without_bounds:
            because = "its surface has no bounds over boxes of (u, v)"
        elif not np.isfinite(most):
            because = "there is no bound (a crease, a singular point, or triangles too far turned)"
        rows.append(
            NotProved(
                face=face, name=mesh.face_name(face), triangles=int(count[face]), of=len(members),
                bound=most, because=because,
                point=as_point(mesh.points[mesh.triangles[worst]].mean(axis=0)),
            )
        )  # fmt: skip
    return tuple(rows)
