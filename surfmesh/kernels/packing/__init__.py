"""Section 2 of the paper: the front, and circles placed at it.

packing: circle packing by an advancing front (Wang, Ming and Lo 2007, section 2) in a metric.
packing_state: everything the packing kernels work on, in one tuple of flat arrays.
front: the generation front (2.1): one closed loop of circles, a doubly linked list.
front_moves: moves of the front over the triangulation of the plane: place a circle, hand a
    triangle over.
heap: a binary heap of directed edges (a, b) with a key, in flat arrays: smallest key first.
circle_fitting: fitting a circle to its neighbours by iteration, its size read from a field
    (2.3.2, 2.3.3).
disc_fitting: fitting a circle of a given radius to its neighbours in closed form (2.3.2, 2.3.3).
disc_packing: one step of the front when radii are drawn at random (Wang, Ming and Lo 2007,
    section 2.3).
"""
