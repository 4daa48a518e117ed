"""What each rule asks for at a point: one file a rule.

across_gaps: sizes at the sides of a gap that put a number of triangles across it.
curvature_size: the edge length that a curvature allows.
direction_size: the edge length that a surface's curvature allows in a given direction.
rim_size: the edge length that the curvature of a rim allows, the part within the surface included.
size_bounds: what the wishes say at a given curvature: the sizes that size fields are made of.
size_limits: upper bounds of the size near points: where a round of meshing has found it too large.
size_rows: one wish a row: what each of them asks for at a point.
direction_rates: how long an edge may be along the direction of low curvature before that turns
    away from it.
volume_rule: the chord at which closed solids keep their volume, where ``Sizing(volume=)`` asks
    for it.
"""
