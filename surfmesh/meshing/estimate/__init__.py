"""How many triangles there will be, before they are made.

estimation: how many triangles there will be, and how much memory they need, before all are packed.
face_counts: the triangles of many faces, by a close look at some of them.
least_counts: the fewest triangles that a chord allows.
model_estimate: the triangles of a CAD model before it is meshed, and a bound that costs nothing.
unmeshed_model: a CAD model before its first mesh: samples of its edges, its faces, what they are
    meshed from.
trial_faces: a few faces of a CAD model, or patches of them, meshed for real: how good the counts
    are.
trial_mesh: a small mesh is made rather than estimated: boundary nodes are integers, and few.
trial_patches: small patches of a face, meshed for real: what becomes of the triangles a size
    field asks for.
"""
