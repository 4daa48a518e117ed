"""The stages of meshing one surface, in the order in which they run.

parametric_mesh     the spine: all stages, and the way round again
packing             room for the packing kernel
boundary_loops      sides and loops cut to unit metric length
boundary_recovery   loops into the packing, the domain cut out
optimise            the order of the optimiser's steps
estimation          triangles and memory before anything is packed
explanation         which rule decides at a point
gluing              into space, joined sides glued
"""
