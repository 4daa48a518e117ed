"""Swaps, smoothing, collapse and split, measured on the surface.

optimisation: optimisation of a triangulated domain: swaps, smoothing, collapse and split.
surface_frames: where the vertices of a planar triangulation lie in space, and how to measure there.
dihedral: angles between the normals of two triangles that share an edge.
"""
