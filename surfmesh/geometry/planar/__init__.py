"""Domains of the plane: loops, holes, lines and points, and the regions that they bound.

planar_domain: domains of the plane z = 0: outer loops, holes, islands, constraint lines and points.
domain_faces: the regions into which the segments of a planar domain divide the plane, as polygons.
line_thinning: lines of a planar domain with fewer points: thinned by Douglas and Peucker,
    topology kept.
nesting: how many loops lie around a loop: even-odd nesting.
noding: noding: segments that meet anywhere are cut there, until they meet at common ends only.
segment_graph: loops, lines and points of a planar domain as one graph of segments, and what is
    inside.
segment_distance: the exact distance to a set of segments in space; a point is a segment without
    length.
shapely_parts: shapely geometries taken apart into arrays.
svg_paths: paths of an SVG drawing as polylines.
curve_contacts: where curves of the plane come together, decided on the curves and not on
    polygons of them.
inside_loops: which points lie within loops.
"""
