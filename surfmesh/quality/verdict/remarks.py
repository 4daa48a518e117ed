"""What is no fault of a mesh and still should be known, one sentence each, with its cure."""

import math

from surfmesh.quality.measures.against_model import Unexpected
from surfmesh.quality.measures.bodies import Bodies
from surfmesh.quality.measures.loose_edges import LooseEdges
from surfmesh.result.surface_mesh import SurfaceMesh

LEAST_SEWN = 1e-6  # of the diagonal: a tolerance for gaps that are none


def touching_bodies(met: Bodies) -> list[str]:
    """Bodies that touch and are meshed each by itself, and those whose facets meet."""
    said = []
    for found, what, cure in (
        (
            met.touching, "touch without a common face",
            "imprint=True of load or from_cadquery (--imprint) has their meshes joined",
        ),
        (
            met.near, "do not touch in the model, and their triangles meet",
            "a smaller chord keeps them apart",
        ),
    ):  # fmt: skip
        if not found:
            continue
        first, count = found[0], len(found)
        meeting = sum(pair.triangles for pair in found)
        pairs = f", {meeting:,} pairs of triangles meet" if meeting else ""
        gap = f", {first.gap:.3g} apart" if first.gap else ""
        place = ", ".join(f"{x:.5g}" for x in first.point)
        said.append(
            f"{count:,} pair{'s' * (count > 1)} of bodies {what}{pairs}: first "
            f"{' and '.join(first.names)} at ({place}){gap}; {cure}"
        )
    return said


def loose_faces(loose: LooseEdges, mesh: SurfaceMesh) -> list[str]:
    """Faces that lie edge to edge and share none."""
    diagonal = max(float((mesh.points.max(axis=0) - mesh.points.min(axis=0)).max()), 1e-300)
    wide = max(2.0 * loose.gap, LEAST_SEWN * diagonal)
    step = 10.0 ** math.floor(math.log10(wide))
    tolerance = f"{math.ceil(wide / step) * step:.0e}"
    place = ", ".join(f"{x:.5g}" for x in loose.point)
    return [
        f"{loose.edges:,} edges of {loose.faces:,} faces lie along edges of other faces and share "
        f"none with them, up to {loose.gap:.2g} apart at ({place}); sew={tolerance} of load or "
        f"from_cadquery (--sew {tolerance}) joins them"
    ]


def sheets_facing_apart(mesh: SurfaceMesh, odd: Unexpected) -> list[str]:
    """Faces of no solid that share an edge and face opposite ways."""
    count = len(odd.sheets_clashing)
    if not count:
        return []
    place = ", ".join(f"{x:.5g}" for x in mesh.points[mesh.edges[odd.sheets_clashing[0]]].mean(0))
    return [
        f"faces of no solid turn opposite sides to each other along {count:,} "
        f"edge{'s' * (count > 1)}, as in the model: first at ({place})"
    ]
