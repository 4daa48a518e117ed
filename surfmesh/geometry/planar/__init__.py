"""Domains of the plane: loops, holes, lines and points, and the regions that they bound.

svg_paths: paths of an SVG drawing as polylines.
given_arrays: what users give as loops, lines and points, as arrays.
shapely_parts: shapely geometries taken apart into arrays.
line_thinning: lines with fewer points: thinned by Douglas and Peucker, topology kept.
point_merging: points that lie so near to each other that they are one.
noding: segments that meet anywhere are cut there, until they meet at common ends only.
segment_graph: loops, lines and points as one graph of segments, and what is inside.
planar_domain: outer loops, holes, islands, constraint lines and points of the plane z = 0.
domain_faces: the regions into which the segments divide the plane, as polygons.
segment_distance: the exact distance to segments in space; a point is a segment without length.
curve_contacts: where curves come together, decided on the curves and not on polygons of them.
curve_circles: where a curve leaves circles around a place.
"""
