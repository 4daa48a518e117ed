"""The size field of a surface: the least of all rules, graded.

boundary_field: the size field of a plane or a cylinder from the sizes at points of its boundary.
field_cells: the cells of a size field under construction: the leaves of a forest of quadtrees.
metric_area: the metric area within loops: how many triangles a size field asks for there.
size_field: the size field of one surface: from its curvature and what is asked for to a background.
size_law: the ungraded target sizes at points of one surface, with what a size field stores there.
small_sizes: where on a surface small sizes lie that samples of it may miss.
"""
