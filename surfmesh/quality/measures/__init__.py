"""Figures of a mesh: of its shape, its sizes, its connectivity, its distance from the surface.

against_model: edges and vertices that are not as the model has them: more triangles, or more fans.
bodies: bodies of a model that overlap, and those that touch without a common face.
by_face: the figures of each face: one row a face, in the order of the faces.
by_solid: the figures of each solid of a CAD model, beside the exact ones.
chord_use: how much of the allowed deviation a mesh uses: one much finer than needed uses little.
deviation: how far the mesh lies from the true surface, and which triangles face the wrong way.
folds: triangles turned far from the surface's normals: by the mesher, by loose edges, by the
    surface.
hidden_search: what may hide between the samples of a triangle or of a rim, by interval arithmetic.
histograms: how the quality is spread: counts in fixed bins, so that reports can be laid side by
    side.
inside: which points lie within a closed surface of triangles: crossings of a ray, counted.
inward: closed surfaces whose triangles face their inside: their volume is negative.
lengths: edge lengths against the wanted ones, and how fast they change from edge to edge.
loose_edges: free rims of faces that lie edge to edge and share nothing: faces that were never sewn.
area_and_volume: how much area and volume a mesh loses or wins by its deviation from the surface.
narrow: triangles of faces narrower than the chord: counted apart, as good shape is not owed there.
pairs_of_ranges: ranges of places, one a row, written out as pairs.
penetration: how deep two triangles go into each other, and how deep facets of a contact may.
tolerances: what was asked for of each face, where it does not hold, and where a ``min_size``
    forbids it.
self_intersection: triangles that meet where they share nothing: every pair, by an exact test.
shape: shape of the triangles in 3D: alpha, radius ratio, angles, areas; the volume they enclose.
solids: the solids of a CAD model's mesh, one by one: a face between two of them counts for both.
surface_to_mesh: how far the true surface lies from the mesh: the other half of the Hausdorff
    distance.
topology: what kind of surface the triangles form: closed, manifold, oriented, in how many pieces.
true_depth: how deep the corners of facets lie within the true body of other facets that they meet.
dihedral: by how much neighbouring triangles turn, where the surface itself does not.
unseen: what no sample of the mesh has seen: features narrower than its triangles, proved absent
    or not.
"""
