"""What the user asks for, and the field of size tensors that follows from it.

sizing           the wishes: one frozen set of options
distance_size    sizes that grow with the distance from lines and points
curvature_size   the edge length that a curvature allows, or two of them
size_bounds      wishes at a given curvature, defaults filled in
direction_size   the edge length that a surface allows in a given direction
size_law         the wish at points of a surface, not yet graded
field_cells      the quadtree of a field under construction
size_limits      upper bounds near points, from an earlier round
size_field       wishes and curvature -> graded sizes on a balanced quadtree
"""
