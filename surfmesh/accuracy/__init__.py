"""How well triangles stand for a surface: what the mesher aims at and the report measures.

Plain arrays of points, triangles and parameters; neither a mesh nor a triangulation is known here.

samples: barycentric places at which triangles are looked at.
deviation: the distance of points, and of triangles, from the true surface.
curved_triangles: the same of quadratic triangles, and of arcs from their curves.
folds: angles between the normals of triangles and surface, and which of them the surface makes.
shape: the mean ratio of triangles, alpha, by their edge vectors.
face_triangles: the triangles of one face, with their parameters and opposite half-edges.
proof: the same distances both ways as proved bounds, of one face.
gaps: where a pole leaves gaps in (u, v) between neighbours.
polar_pieces: how triangles at a pole move to the surface, along rays.
projected_pieces: those of spheres, cylinders and cones, by their nearest points.
finer_pieces: finer meshes on the way to the surface, where triangles are large for how it bends.
joined_faces: how triangles of several faces move to their surfaces together.
dihedral: angles between neighbouring triangles, and which of them the surface makes.
"""
