"""What the mesh of a solid must be, from its B-rep alone: Euler number, volume, area.

For a cell complex V - E + F holds when all faces are discs. A face with b pieces of boundary
counts 2 - b (a disc 1, a ring 0), so that

    chi = V - E + sum (2 - b) = V - E + F - (L - F)        L: pieces of boundary of all faces

A seam is one edge, whichever number of times its face uses it; a degenerate edge is a point and
no edge. Loops that touch in (u, v) are one piece.
"""

from collections import Counter

import numpy as np

from surfmesh.cad.model.cad_model import CadFace, CadModel, CadSolid

SAME_PLACE = 1e-4  # of the (u, v) box: loops so near at a common vertex touch there


def solid_facts(model: CadModel, solid: CadSolid) -> dict:
    """closed, euler, volume, area; most: uses of any edge, above 2 where the solid touches
    itself; faces: their numbers."""
    faces = [face for shell in solid.shells for face, _ in shell]
    uses = Counter(coedge.edge for face in faces for coedge in model.faces[face].coedges)
    edges = [edge for edge in uses if not model.edges[edge].degenerate]
    vertices = {end for edge in uses for end in (model.edges[edge].start, model.edges[edge].end)}
    inside = sum(2 - boundary_pieces(model, model.faces[face]) for face in faces)
    return {
        "closed": solid.closed,
        "euler": len(vertices) - len(edges) + inside,
        "most": max((uses[edge] for edge in edges), default=0),
        "volume": solid.volume,
        "area": float(sum(model.faces[face].area for face in faces)),
        "faces": faces,
    }


def boundary_pieces(model: CadModel, face: CadFace) -> int:
    """Loops, those that touch at a vertex counted together."""
    piece = list(range(len(face.loops)))
    if len(piece) == 1:
        return 1
    width = np.ptp(np.array(face.surface.domain), axis=1)
    met: dict[int, list] = {}  # vertex -> (loop, uv) of the corners there
    for loop, coedges in enumerate(face.loops):
        for coedge in coedges:
            edge = model.edges[coedge.edge]
            here = met.setdefault(edge.end if coedge.reversed else edge.start, [])
            uv = coedge.walk(np.zeros(1))[0] / width
            for other, there in here:
                if np.abs(uv - there).max() <= SAME_PLACE:
                    old, new = piece[loop], piece[other]
                    piece = [new if p == old else p for p in piece]
            here.append((loop, uv))
    return len(set(piece))
