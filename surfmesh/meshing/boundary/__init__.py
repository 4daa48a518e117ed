"""Boundaries in (u, v): cut to metric length, taken apart, inserted.

In the order in which data passes:

cusps: poles where the surface is thinner than any cone: horns, needles, drops with a pointed end.
boundary_loops: the boundary of a surface in (u, v): sides and trimming loops cut to unit metric
    length.
kink_segments: kink lines of a surface cut to metric length: segments that the mesh follows within.
planar_segments: step 1 of section 3 in the plane: the segments of a domain, cut to unit metric
    length.
untangling: boundaries that cross themselves by less than the tolerance of their edges, taken apart.
boundary_recovery: what is wrong with a boundary that cannot be inserted into a packing (section 3).
"""
