"""What the figures mean: what is wrong, what should be known, and where they are worst.

finding: what a finding is: its kind, its place and its numbers; the sentence is made when it is
    read.
connectivity: edges, vertices and solids that are not as in the model, or as on a surface.
triangles: triangles without area, and triangles turned far from the surface's normals.
accuracy: where the mesh does not follow its surfaces as closely as was asked for.
contacts: triangles that meet where they share nothing: of one body, of two, of faces never sewn.
orientation: solids and closed surfaces that face their inside.
area_and_volume: solids and faces that have not the volume or area of the model.
problems: why a mesh is not clean: everything that is wrong, in the order in which it is said.
remarks: what is no fault of a mesh and still should be known, likewise.
worst: the worst triangles, each with where it is.

``worst`` is used by ``SurfaceMesh`` too.
"""
