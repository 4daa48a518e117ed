"""What each rule asks for at a point: one file a rule.

    curvatures, places  ->  each rule  ->  the least of all, within bounds  ->  sizing/field

What a rule is, and the formulas that several of them need:

rule: what a size rule is: the edge length that it allows at a place, and words for it.
curvature_size: the edge length that a curvature allows.
direction_size: the edge length that a surface's curvature allows in a given direction.
direction_rates: how long an edge may be where the direction of low curvature changes.

The rules:

chord_rule: ``chord``, of surfaces and of curves.
quadratic_chord_rule: ``chord`` of quadratic triangles.
rim_rule: ``chord`` where a surface ends: the edge length that the curvature of a rim allows.
angle_rule: ``angle``.
default_angle_rule: the angle that holds where only a chord is asked for.
size_rule: ``size``: a number, or a function of the place.
across_gaps: sizes at the sides of a gap that put a number of triangles across it.
source_rule: ``sources``: local sizes near points and lines, in balls and boxes, across gaps.
volume_rule: the chord at which closed solids keep their volume, where ``volume`` asks for it.

All of them together:

size_limits: upper bounds of the size near points: where a round of meshing has found it too large.
principal_lattice: where a lattice of triangles keeps to principal directions and may be larger.
size_rules: all rules that hold on one surface, and the bounds that their least size is kept within.

A new rule is a file like ``size_rule`` and its name in ``size_rules.RULES``.
"""
