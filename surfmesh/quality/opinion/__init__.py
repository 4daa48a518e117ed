"""The figures of other libraries beside ours.

second_opinion: a second opinion: the figures of the report beside those of trimesh and of PyVista.
libraries_asked: what trimesh and PyVista (VTK) say of a mesh. Both are imported when they are
    asked.
opinion_rows: one figure of the report beside that of a library, and whether they agree.
rounding_bounds: how far two computations of one figure can lie apart by rounding alone.
shapes_compared: shapes of triangles by Verdict beside ours: of every triangle, and as the report
    has them.
"""
