"""What is measured and decided in three dimensions.

space_predicates: exact orientation of four points in space, by the same means as in the plane.
triangle_pairs: do two triangles in space meet where they should not? Judged exactly.
box_tree: pairs of triangles whose boxes overlap, by a balanced binary tree of boxes.
edge_distances: how far the edges of a face are apart: distances from samples of one to the others.
measure: measures of a finished mesh: shapes of triangles, distances to a surface, connected parts.
nurbs: b-spline curves and surfaces, rational or not, with derivatives up to the third order.
"""
