"""Faces become solids: their meshes joined by number, what is missing of them, volumes.

joining: the meshes of all faces joined into one: what neighbours share are the numbers of nodes.
    ``orientation`` is for others too.
crowded_chords: chords that two faces made between the same nodes, cut in one of them.
model_findings: what the user should know of the mesh of a CAD model: findings, and the sentences
    made of them.
groups: what a CAD model says of its parts, in the plain form that a mesh carries.
volumes: volumes of the meshes of closed solids, against what ``Sizing(volume=)`` asks for.
"""
