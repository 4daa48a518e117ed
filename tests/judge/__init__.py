"""Judges of meshes, and random things to mesh, that share no code with the mesher."""
