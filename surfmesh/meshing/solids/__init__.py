"""Faces become solids: parts by name, volumes.

groups: what a CAD model says of its parts, in the plain form that a mesh carries.
volumes: volumes of the meshes of closed solids, against what ``Sizing(volume=)`` asks for.
"""
