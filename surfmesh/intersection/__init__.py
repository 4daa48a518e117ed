"""Surfaces that meet: their common curves as edges that the faces on all sides share.

    surfaces, models -> sheets -> contacts -> branches -> curve_fitting -> arrangement -> keeping
                        faces     nodes       traced      splines          regions      a CadModel

The paper's last section: "the boundary of surface can be conveniently introduced through the
intersection of discretised surfaces". Others use ``intersect`` alone.

meeting_file: surfaces that meet, as a TOML file; ready-made ones.
intersect: the whole way, and the tags of the result.
seams: where closed surfaces of formulas have their seams: out of the way of the others.
sheets: what is intersected, each as a model: a surface over a rectangle becomes one face.
complex: vertices, edges and faces that share them by number, and where each face comes from.
bounds: how far surfaces and curves bend over cells: boxes that hold them, cones of normals.
cells: the (u, v) box of a face in cells, an edge likewise, halved level after level.
newton: points pulled onto two surfaces, or onto a curve and a surface.
regions: which points of the (u, v) plane lie within the loops of a face.
piercings: where an edge meets the surface of a face: all places.
elementary_distances: planes, cylinders, cones, spheres, tori: distances, and which are one surface.
edge_meetings: where two edges meet, and where they run together.
pcurve_fitting: curves in the (u, v) of a face that follow an edge lying on it.
contacts: where the edges of each of two complexes meet the faces and edges of the other: nodes.
touching: points where a curve touches a surface, or two surfaces, and the ways out of them.
poles: where curves leave a pole of a surface.
tracing: curves traced on two surfaces, from a start to the end that they come to.
contact_curves: curves along which two surfaces touch, followed from end to end.
branches: all branches of the curve in which two faces meet, closed ones too.
curve_fitting: a traced branch as splines, in space and in both (u, v).
arrangement: the curves on one face cut it into regions.
borders: the border of a face with its coedges cut at nodes, and the places of nodes.
edge_parts: edges cut at nodes: parts that both complexes share, parts that lie in faces.
overlaps: patches of both complexes that coincide: merged, or refused.
meeting: two complexes become one: their faces cut each other along common edges.
contents: areas of faces and volumes under them, by integrals over their regions in (u, v).
insides: which points lie inside closed models, by rays.
signs: on which side of each other input a patch lies.
shells: faces that enclose bodies: shells by common edges, solids by which lies in which.
keeping: what is kept, and the solids that it encloses.
"""
