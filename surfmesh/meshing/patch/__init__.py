"""One (u, v) domain and one size field become triangles: the spine of surfmesh, once.

Others call ``mesh_patch``, go round in ``refined_in_rounds``, and pack by themselves with
``packed``; the rest is of this room. In the order in which data passes:

packing: drive the packing kernel: room for its arrays, growing them when they are full.
state: the state of the optimiser, which runs in the core (src/patch).
size_requests: upper bounds of the size, for another round, where that could not mend it.
patch_mesh: all of these in their order, for every kind of boundary.
refinement_loop: rounds with smaller sizes until nothing is to be mended, or smaller sizes are no
    help.
"""
