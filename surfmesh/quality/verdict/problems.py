"""Why a mesh is not clean: everything that is wrong, in the order in which it is said."""

from surfmesh.quality.measures.face_rows import FaceRows
from surfmesh.quality.measures.measurements import Measurements
from surfmesh.quality.verdict.accuracy import (
    angle_exceeded,
    deviation_exceeded,
    features_unseen,
    not_proved,
    surface_deviation_exceeded,
    vertices_off_surface,
)
from surfmesh.quality.verdict.area_and_volume import (
    VolumeExceeded,
    unexplained,
    volumes_exceeded,
)
from surfmesh.quality.verdict.connectivity import odd_connectivity
from surfmesh.quality.verdict.contacts import overlaps, self_intersections
from surfmesh.quality.verdict.finding import Fault, Kind, MissingFace, Problem
from surfmesh.quality.verdict.triangles import bad_triangles
from surfmesh.result.findings import FindingKind


def problems(measured: Measurements, faces: FaceRows, prove: bool = False) -> tuple[Problem, ...]:
    """faces: the figures of each. prove: bounds are asked for."""
    mesh, found = measured.mesh, list[Problem]()
    if not len(mesh.triangles):
        found.append(Fault(kind=Kind.NO_TRIANGLES, words="the mesh has no triangles"))
    if measured.broken:
        found.append(Fault(kind=Kind.BROKEN_MESH, words=measured.broken))
    missing = [
        MissingFace(face=one.face, words=one.text, place=one.place)
        for one in mesh.findings
        if one.kind is FindingKind.NOT_MESHED
    ]
    found += missing
    found += odd_connectivity(measured, missing=bool(missing))
    found += bad_triangles(measured)
    found += deviation_exceeded(measured)
    found += vertices_off_surface(measured)
    found += (one for one in volumes_exceeded(measured) if isinstance(one, VolumeExceeded))
    found += surface_deviation_exceeded(measured)
    found += features_unseen(measured)
    if prove and measured.mesh.sizing is not None and measured.mesh.sizing.proof:
        found += not_proved(measured)
    found += angle_exceeded(measured)
    found += self_intersections(measured)
    found += overlaps(measured)
    found += unexplained(measured, faces)
    return tuple(found)
