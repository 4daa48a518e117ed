"""Sections 2 and 3 of Wang, Ming and Lo 2007 in plain Python, to be read beside the paper.

Slow: a few hundred circles a second. The tests compare the fast code with it. In the order in which
data passes:

size_tensors: points, size tensors, and what is measured with them: length, shape, orientation.
plane_triangulation: a triangulation of the whole plane, and its local changes.
field_packing: circles of the sizes of a field, packed along the generation front (2).
boundary_insertion: the five steps that cut a domain out (3).

Points are complex numbers x + iy, indices start at 0, a size tensor H has the "circle"
|H^-1 (x - p)| <= 1/2. Every topological decision is made in exact rational arithmetic. Nothing
else in surfmesh imports this room.
"""
