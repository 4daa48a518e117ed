"""One (u, v) domain and one size field become triangles.

packing: drive the packing kernel: room for its arrays, growing them when they are full.
optimise: the order of the optimiser's steps; what each does is in
    kernels.optimisation.optimisation.
gluing: from the parameter plane to space: points on the surface, joined sides glued.
refinement_loop: rounds with smaller sizes until nothing is to be mended, or smaller sizes are no
    help.
"""
