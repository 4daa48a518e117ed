"""Parts -> one `CadModel`, exactly or not at all.

model_of_parts: how parts become one model: healed, scaled, placed, joined, and walked through.
placing: every part is healed and scaled once, then put where the assembly wants it.
topology: solids, shells, faces and tags by number, each once.
edges_met: edges and vertices by number, and the loops that faces make of them.
convert: geometry of OCP -> curves and surfaces of `surfmesh.geometry`.
points_inside: a vertex inside a face, where another body touches it in a point, gets a short edge.
contents_of_file: what a CAD file holds that has no faces: curves, points, CSG, sweeps,
    triangles, with counts.
"""
