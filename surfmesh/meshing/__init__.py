"""From a surface, a domain or a model and its sizes to triangles.

parametric_mesh, planar_mesh, model_mesh: the three drivers, which others call.
model_rounds: the rounds in which a CAD model is meshed, for one set of sizes.
boundary: loops in (u, v), cut to metric length, taken apart, inserted.
patch: one domain and one size field become triangles, once for all; the rounds of refinement.
edges: edges of a CAD model, each cut once for all its faces.
faces: one face of a CAD model, and what is done where it is narrow, thin or faulty.
solids: faces joined, groups, volumes.
finishing: second order, vertices off the surface, short edges collapsed.
estimate: how many triangles there will be.
triangle_count: sizes for a wanted number of triangles.
explain: which rule decides the size at a point.
executors: those that callers give: what is none, and what goes wrong with one that is.
processors: how many there are, and how many threads a call of the core may use.
progress: stages, their seconds, and a caller who may stop the work.
"""
