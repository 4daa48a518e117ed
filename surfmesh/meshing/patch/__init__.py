"""One (u, v) domain and one size field become triangles: the spine of surfmesh, once.

Others call ``mesh_patch``, go round in ``refined_in_rounds``, and pack by themselves with
``packed``; the rest is of this room. In the order in which data passes:

packing: what circles are packed over; packing by itself; why a packing cannot go on.
size_requests: upper bounds of the size, for another round, where the optimiser could not mend it.
proved_patch: triangles are cut, or smaller sizes asked for, where the chord is not proved to hold.
patch_mesh: all stages in one call of the core (src/patch), for every kind of boundary.
refinement_loop: rounds with smaller sizes until nothing is to be mended, or smaller sizes are no
    help.
"""
