"""The triangulation of the plane, its predicates, and its local changes.

triangulation: a triangulation of the whole plane in flat arrays, with ghost triangles at the hull.
predicates: exact orientation of three points: the one judge of every topological decision.
exact_sums: the sign of a sum of numbers of any size, exactly: what predicates fall back on.
local_operations: local changes of a triangulation: swap an edge, remove a vertex. Orientation is
    kept exactly.
segments: how two segments of the plane meet, decided exactly; and distances to many segments.
"""
