"""What may be done to a finished mesh: six nodes a triangle, short edges collapsed.

second_order: a node amid every edge of a mesh, on the true curve or surface, one for all its
    triangles.
edge_collapse: short edges of a finished mesh, collapsed: tiny edges and slivers of a CAD model
    go away.
"""
