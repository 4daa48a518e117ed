"""Section 3 of the paper: boundary nodes and segments by tracing neighbours.

insertion: boundary insertion by tracing neighbours (Wang, Ming and Lo 2007, section 3).
boundary_row: the row of vertices along a boundary, where equilateral triangles over its segments
    have them.
"""
