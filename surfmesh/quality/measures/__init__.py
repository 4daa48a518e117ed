"""Figures of a mesh: of its shape, its sizes, its connectivity, its distance from the surface.

places: points as the report has them, and in words.
known_surfaces: a mesh whose surfaces and corner parameters are known.

Connectivity and shape:
topology: what kind of surface the triangles form: closed, manifold, oriented, in how many pieces.
proved_isotopy: can the mesh be deformed into its surface through space?
proved_topology: is the mesh homeomorphic to what it was made of, and more? By exact predicates.
against_model: edges and vertices that are not as the model has them: more triangles, or more fans.
torn_edges: free edges within a surface: a triangle is missing beside them.
curved: quadratic triangles: area, volume, Jacobian, and their distance from the surface.
shape: shape of the triangles in 3D: alpha, radius ratio, angles, areas; the volume they enclose.
narrow: triangles of faces narrower than the chord: counted apart, as good shape is not owed there.
joined: the mesh with its edge table, as the core takes it: looked at once for all figures.
lengths: edge lengths against the target sizes, and how fast they change from edge to edge.
spread: least, mean and largest of values.
histograms: how the quality is spread: counts in fixed bins, so that reports can be laid side by
    side.
solids: the solids of a CAD model's mesh, one by one: a face between two of them counts for both.
by_solid: the figures of each solid of a CAD model, beside the exact ones.
inside: which points lie within a closed surface of triangles: crossings of a ray, counted.
pairs_of_ranges: ranges of places, one a row, written out as pairs.
inward: closed surfaces whose triangles face their inside: their volume is negative.

Accuracy:
deviation: how far the mesh lies from the true surface, and which triangles face the wrong way.
off_surface: vertices that lie off the surface of their triangles where no ``chord`` says how far
    they may.
folds: triangles turned far from the surface's normals: by the mesher, by loose edges, by the
    surface.
dihedral: dihedral angles between neighbouring triangles, where the surface itself has no crease.
tolerances: what was asked for of each face, where it does not hold, and where a ``min_size``
    forbids it.
chord_use: how much of the allowed deviation a mesh uses: one much finer than needed uses little.
least_triangles: how many triangles the chord needs at least.
surface_to_mesh: how far the true surface lies from the mesh: the other half of the Hausdorff
    distance.
hidden_search: what may hide between the samples of a triangle or of a rim, by interval arithmetic.
bent_sides: triangles that are straight in the plane that was meshed alone, cut into small ones.
unseen: what no sample of the mesh has seen: features narrower than its triangles, proved absent
    or not.
proof: how far mesh and surfaces are from each other at most, proved, on request.
area_and_volume: how much area and volume a mesh loses or wins by its deviation from the surface.

Triangles that meet:
self_intersection: triangles that meet where they share nothing: every pair, by an exact test.
penetration: how deep two triangles go into each other, and how deep facets of a contact may.
loose_edges: free rims of faces that lie edge to edge and share nothing: faces that were never sewn.
coincident_edges: free edges that lie on each other and share no vertices: triangles that were
    never joined.
true_depth: how deep the corners of facets lie within the true body of other facets that they meet.
overlap_depth: how deep two solids that overlap go into each other: measured at their vertices.
bodies: bodies of a model that overlap, and those that touch without a common face.

measurements: all of these of one mesh, each when it is first asked for.
face_rows: a row of figures a face, made when it is asked for.
by_face: the figures of each face, in the order of the faces.

``shape``, ``deviation`` and ``tolerances`` are used by ``io`` and ``view`` too.
"""
