"""Euler's number of a solid from its B-rep: V - E + F less one for each further boundary of a face.

Loops of a face that share a vertex are one boundary; degenerate edges are no edges in space.
"""


def brep_euler(model, solid):
    """V - E + sum over faces of (2 - boundaries)."""
    faces = [model.faces[face] for shell in model.solids[solid].shells for face, _ in shell]
    edges = {coedge.edge for face in faces for coedge in face.coedges}
    vertices = {v for e in edges for v in (model.edges[e].start, model.edges[e].end)}
    real = [e for e in edges if not model.edges[e].degenerate]
    return len(vertices) - len(real) + sum(2 - boundaries(model, face) for face in faces)


def boundaries(model, face):
    """Connected components of the loops of a face."""
    groups = []
    for loop in face.loops:
        group = {v for c in loop for v in (model.edges[c.edge].start, model.edges[c.edge].end)}
        for other in [g for g in groups if g & group]:
            groups.remove(other)
            group |= other
        groups.append(group)
    return len(groups)
