"""Seams identified as one would say it: with sets and dictionaries."""

from collections import Counter
from itertools import pairwise

from surfmesh._core import NIL


def identified(tri, adj, live, node, segments, identity):
    """Triangles of points, their corners, the vertex of each point, bad points.

    tri, adj: rows of three for each triangle, ``live`` says which count.
    """
    corners = [tuple(row) for row, is_live in zip(tri, live) if is_live]
    used = sorted({v for row in corners for v in row})
    same = {v: v for v in used} | {node[k]: node[identity[k]] for k in range(len(node))}
    vertex = [v for v in used if same[v] == v]
    number = {v: k for k, v in enumerate(vertex)}
    joined = len(identity) - len(set(identity))
    rows = [tuple(number[same[v]] for v in row) for row in corners]
    if not joined:
        return rows, corners, vertex, []
    solid = [len(set(row)) == 3 for row in rows]
    lost = [row for row, whole in zip(rows, solid) if not whole]
    corners = [row for row, whole in zip(corners, solid) if whole]
    triangles = [row for row, whole in zip(rows, solid) if whole]
    uses = Counter(edge for row in triangles for edge in edges_of(row))
    bad = {p for edge, count in uses.items() if count > 2 for p in edge}
    collapsed, change = changes(segments, identity, joined)
    if len(lost) != collapsed:
        bad |= {p for row in lost for p in row}
    border = sum(f == NIL for row, is_live in zip(adj, live) if is_live for f in row)
    before = len(used) - (3 * len(rows) + border) // 2 + len(rows)
    if not bad and len(vertex) - len(uses) + len(triangles) != before + change:
        bad = set(range(len(vertex)))
    return triangles, corners, vertex, sorted(bad)


def edges_of(row):
    return [tuple(sorted(edge)) for edge in pairwise((*row, row[0]))]


def changes(segments, identity, joined):
    """How many segments collapse to points, and by how much Euler's number changes."""
    once = {tuple(sorted(segment)) for segment in segments}
    ends = [tuple(sorted((identity[a], identity[b]))) for a, b in once]
    collapsed = sum(a == b for a, b in ends)
    kept = [pair for pair in ends if pair[0] != pair[1]]
    return collapsed, collapsed + len(kept) - len(set(kept)) - joined
