"""The figures of other libraries beside ours.

rounding_bounds: how far two computations of one figure can lie apart by rounding alone.
libraries_asked: what trimesh and PyVista (VTK) say of a mesh. Both are imported when they are
    asked.
witness: the rows of one library: its figures beside ours, and whether they agree.
shapes_compared: shapes of triangles by Verdict beside ours: of every triangle, and as the report
    has them.
second_opinion: the figures of the report beside those of trimesh and of PyVista.
findings: what the second opinion says of a mesh, in sentences.
"""
