"""What the user asks for, and the field of size tensors that follows from it.

sizing           the wishes: one frozen set of options
distance_size    sizes that grow with the distance from lines and points
curvature_size   the edge length that a curvature allows, or two of them
size_bounds      wishes at a given curvature, defaults filled in
direction_size   the edge length that a surface allows in a given direction
sources          local sizes: near points and lines, in balls and boxes, from other meshes
small_sizes      where on a surface sources ask for sizes that samples may miss
across_gaps      sizes that put a number of triangles across a gap
model_sizing     selections of a CAD model -> wishes of each face, edge and vertex
sizes_file       selections in TOML
size_rows        what each wish asks for at a point, one by one
metric_area      how many triangles a field asks for within loops
size_law         the wish at points of a surface, not yet graded
field_cells      the quadtree of a field under construction
size_limits      upper bounds near points, from an earlier round
size_field       wishes and curvature -> graded sizes on a balanced quadtree
"""
