"""What may be done to a finished mesh: six nodes a triangle, vertices balanced,
short edges collapsed.

mid_nodes: nodes amid edges slide along the surface so that curved triangles lie nearer to it.
second_order: a node amid every edge of a mesh, on the true curve or surface, one for all its
    triangles.
curved_requests: upper bounds of the size, for another round, where quadratic triangles are farther
    from the surface than the chord.
signed_distances: how far triangles lie from their surfaces, and on which side.
vertex_sites: vertices as their faces see them, steps that move them by given lengths.
kept_volumes: steps that give solids their exact volumes.
balanced_vertices: vertices off their surfaces, which then lie on both sides of the triangles.
turned_edges: edges across which triangles have come to turn by more than ``angle``, as their
    vertices moved.
enclosed_solids: the closed solids that a mesh encloses, whose volumes are known or can be found.
balanced_rounds: meshes of that kind, sizes for nearly twice the chord and smaller where need be.
edge_collapse: short edges of a finished mesh, collapsed: tiny edges and slivers of a CAD model
    go away.
"""
