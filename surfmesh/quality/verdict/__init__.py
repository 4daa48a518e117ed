"""What the figures mean: problems, remarks, and where they are worst.

problems: what is wrong with a mesh, one sentence for each thing: how many, and where the first is.
remarks: what is no fault of a mesh and still should be known, one sentence each, with its cure.
provenance: what a mesh was made with, and a fingerprint of what came out.
worst: the worst triangles, each with where it is.
"""
