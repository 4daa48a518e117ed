"""What follows from derivatives: forms, curvatures, charts, sides, closest points.

fundamental_forms: first and second forms, normals, principal curvatures and directions, areas.
infinite_speed: places on an axis of (u, v) where the speed has no bound, and the axis bent until
    it has one.
chart: the scaled plane (x, y): u and v each stretched so that speeds are about one.
sides: the four sides of the (u, v) rectangle: which coincide in space, which shrink to a point.
projection: the closest point of a surface, near a guess.
sharp_bends: where a surface itself turns over: at a cusp, a crease, a swallowtail, a tube of no
    width.
"""
