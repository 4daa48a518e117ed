"""Boundary insertion by tracing neighbours: the five steps of section 3."""

from collections.abc import Callable, Sequence

from surfmesh.reference.plane_triangulation import DEAD, NIL, Edge, Triangle, Triangulation, sides
from surfmesh.reference.size_tensors import SizeTensor, dot, length, mean

MOVE_WITHIN = 0.35  # a vertex nearer than this to a new node becomes that node
CROWDED = 0.5  # distance from the boundary below which a vertex is removed
BAD_SHAPE, SWEEPS = 0.7, 8  # triangles below this alpha are offered a swap


def insert_boundary(
    plane: Triangulation, size: Callable[[complex], SizeTensor], nodes: Sequence[complex],
    rim: Sequence[Edge], lines: Sequence[Edge] = (),
) -> list[Triangle]:  # fmt: skip
    """Cut a domain out of the plane. Returns its triangles.

    Step 1, to identify the segments, has been done: pairs of ``nodes``, each about as long as is
    wanted there. What is left of ``rim`` is inside, and what is on both sides of ``lines``.
    """
    plane.barriers.clear()
    edge = sides(next(triangle for triangle in plane.triangles if triangle != DEAD))[0]
    vertices: list[int] = []
    for p in nodes:
        edge = insert_node(plane, edge, p, size(p), set(vertices))
        vertices.append(edge[0])
    segments = [(vertices[a], vertices[b]) for a, b in [*rim, *lines]]
    for a, b in segments:
        recover_segment(plane, a, b, set(vertices))
    inner = segments + [(b, a) for a, b in segments[len(rim) :]]
    clear_boundary(plane, inner, set(vertices))
    inside = plane.patch(plane.left[side] for side in inner)  # step 5
    if any(NIL in plane.triangles[t] for t in inside):
        raise ValueError("the boundary does not enclose a domain")
    swap_bad(plane, inside)
    return [plane.triangles[t] for t in inside]


def insert_node(
    plane: Triangulation, edge: Edge, p: complex, h: SizeTensor, nodes: set[int]
) -> Edge:
    """Step 2: make p a vertex, sought from an edge on. Returns an edge that starts there.

    A near vertex is moved there, or the triangle, or the edge, that holds p is split.
    """
    t, _ = plane.locate(edge, p)
    for v, w in sides(plane.triangles[t]):
        if v in nodes or v == NIL or length(h.solve(plane.points[v] - p)) >= MOVE_WITHIN:
            continue
        star = plane.around(v, w)
        if NIL not in star and all(plane.side(a, b, p) > 0 for a, b in zip(star, star[1:] + [w])):
            plane.points[v], plane.sizes[v] = p, h
            return v, w
    for metric in (h, None):
        cavity = plane.open_cavity(t, p, metric)
        if cavity.rim:
            return plane.fill_cavity(cavity, p, h), cavity.rim[0][0]
    raise ValueError(f"the boundary touches itself at {p}")


def recover_segment(plane: Triangulation, a: int, b: int, nodes: set[int]) -> None:
    """Step 3: make a-b an edge. Vertices that lie exactly on it are removed."""
    while (a, b) not in plane.left:
        cut, v, beside = trace(plane, a, b)
        if v == b:
            swap_out(plane, a, b, cut)
        elif v in nodes or not plane.remove_vertex(v, beside):
            raise ValueError("a segment runs through a node")
    plane.barriers |= {(a, b), (b, a)}


def trace(plane: Triangulation, a: int, b: int) -> tuple[list[Edge], int, int]:
    """Step 3: the edges that a -> b cuts, from triangle to neighbour, and the vertex met.

    Each edge runs from its right end to its left one; the last result is a neighbour of the vertex.
    """
    star, end = plane.around(a, next(w for v, w in plane.left if v == a)), plane.points[b]
    ways = zip(star, star[1:] + star[:1])
    right, left = next(w for w in ways if plane.side(a, w[0], end) >= 0 > plane.side(a, w[1], end))
    if plane.side(a, right, end) == 0:
        return [], right, a
    cut = [(right, left)]
    while True:
        right, left = cut[-1]
        if (right, left) in plane.barriers:
            raise ValueError("two segments cross")
        v = plane.apex(left, right)
        s = plane.side(a, b, plane.points[v])
        if v == b or s == 0:
            return cut, v, left
        cut.append((v, left) if s < 0 else (right, v))


def swap_out(plane: Triangulation, a: int, b: int, cut: list[Edge]) -> None:
    """Step 3: swap the edges that a-b cuts until it is an edge (Sloan 1993)."""
    while cut:
        p, q = cut.pop(0)
        c, d = plane.apex(p, q), plane.apex(q, p)
        if not plane.swap(p, q):
            cut.append((p, q))
        elif not {a, b} & {c, d}:
            if (plane.side(a, b, plane.points[c]) < 0) != (plane.side(a, b, plane.points[d]) < 0):
                cut.append((d, c))


def clear_boundary(plane: Triangulation, inner: list[Edge], nodes: set[int]) -> None:
    """Step 4: remove the vertices left of the segments that are too near to them."""
    for a, b in inner:
        v = plane.apex(a, b)
        while crowds(plane, a, b, v, nodes) and plane.remove_vertex(v, a):
            v = plane.apex(a, b)
        v = b
        while (a, v := plane.apex(a, v)) not in plane.barriers:
            if crowds(plane, a, b, v, nodes) and plane.remove_vertex(v, a):
                v = b


def crowds(plane: Triangulation, a: int, b: int, v: int, nodes: set[int]) -> bool:
    """Is v, which is no node, too near to the segment a-b?"""
    metric = mean(plane.sizes[a], plane.sizes[b], plane.sizes[v], plane.sizes[v])
    way, step = (metric.solve(plane.points[w] - plane.points[a]) for w in (b, v))
    t = min(max(dot(way, step) / dot(way, way), 0.0), 1.0)
    return v not in nodes and length(step - t * way) < CROWDED


def swap_bad(plane: Triangulation, inside: list[int]) -> None:
    """Step 4: swap edges of badly shaped triangles while that betters the worse of two."""
    for t in SWEEPS * inside:
        for i in range(3):
            if plane.shape(*plane.triangles[t]) < BAD_SHAPE:
                plane.choose_diagonal(*sides(plane.triangles[t])[i])
