"""What the user asks for, and the field of size tensors that follows from it.

sizing           the wishes: one frozen set of options
distance_size    sizes that grow with the distance from lines and points
curvature_size   the edge length that a curvature allows
size_limits      upper bounds near points, from an earlier round
size_field       wishes and curvature -> graded sizes on a balanced quadtree
"""
