"""What the user asks for, and the field of size tensors that follows from it.

sizing           the wishes: one frozen set of options
distance_size    sizes that grow with the distance from lines and points
curvature_size   the edge length that a curvature allows
sources          local sizes: near points and lines, in balls and boxes, from other meshes
model_sizing     selections of a CAD model -> wishes of each face, edge and vertex
sizes_file       selections in TOML
size_rows        what each wish asks for at a point, one by one
metric_area      how many triangles a field asks for within loops
size_limits      upper bounds near points, from an earlier round
size_field       wishes and curvature -> graded sizes on a balanced quadtree
"""
