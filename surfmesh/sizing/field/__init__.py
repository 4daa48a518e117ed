"""The size field of a surface: the least of all rules, graded.

size_law: the ungraded target sizes at points of one surface, with what a size field stores there.
small_sizes: where on a surface small sizes lie that samples of it may miss.
field_builder: the background of a size field: sizes graded on a balanced quadtree.
size_field: the size field of one surface, ready for the core.
boundary_field: the size field of a plane or a cylinder from the sizes at points of its boundary.
metric_area: the metric area within loops: how many triangles a size field asks for there.
"""
