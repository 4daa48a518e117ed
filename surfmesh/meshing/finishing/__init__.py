"""What may be done to a finished mesh: six nodes a triangle, short edges collapsed.

mid_nodes: nodes amid edges slide along the surface so that curved triangles lie nearer to it.
second_order: a node amid every edge of a mesh, on the true curve or surface, one for all its
    triangles.
curved_requests: upper bounds of the size, for another round, where quadratic triangles are farther
    from the surface than the chord.
edge_collapse: short edges of a finished mesh, collapsed: tiny edges and slivers of a CAD model
    go away.
"""
