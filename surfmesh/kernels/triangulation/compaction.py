"""From the triangulation of the plane to that of a domain: what is INSIDE, numbered anew."""

from surfmesh.kernels import NIL
from surfmesh.kernels.jit import kernel


@kernel
def number_inside(t, inside, triangle_number, vertex_number):
    """Number the triangles of region ``inside`` and their vertices, in the order they have.

    triangle_number (triangles,) and vertex_number (vertices,) int32 are filled, NIL for what
    is left out. Returns (triangles, vertices) inside.
    """
    for v in range(t.count[0]):
        vertex_number[v] = NIL
    triangles = 0
    for k in range(t.count[1]):
        triangle_number[k] = NIL
        if t.region[k] == inside:
            triangle_number[k] = triangles
            triangles += 1
            for i in range(3):
                vertex_number[t.tri[3 * k + i]] = 0
    vertices = 0
    for v in range(t.count[0]):
        if vertex_number[v] != NIL:
            vertex_number[v] = vertices
            vertices += 1
    return triangles, vertices


@kernel
def copy_inside(t, triangle_number, vertex_number, out):
    """Write the numbered part into ``out``; half-edges on its border have no twin (NIL)."""
    triangles = 0
    for k in range(t.count[1]):
        n = triangle_number[k]
        if n == NIL:
            continue
        triangles += 1
        out.region[n] = 0
        for i in range(3):
            e = 3 * k + i
            out.tri[3 * n + i] = vertex_number[t.tri[e]]
            out.fixed[3 * n + i] = t.fixed[e]
            twin = t.adj[e]
            m = triangle_number[twin // 3] if twin >= 0 else NIL
            out.adj[3 * n + i] = 3 * m + twin % 3 if m != NIL else NIL
    vertices = 0
    for v in range(t.count[0]):
        n = vertex_number[v]
        if n == NIL:
            continue
        vertices += 1
        for i in range(2):
            out.xy[n, i] = t.xy[v, i]
        for i in range(3):
            out.size[n, i] = t.size[v, i]
    out.count[0] = vertices
    out.count[1] = triangles
