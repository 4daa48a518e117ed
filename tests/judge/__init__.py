"""Judges of meshes that share no code with the mesher, and random things to mesh.

``solids``, ``domains`` and ``surfaces`` judge a mesh by its points and triangles alone, against
OpenCASCADE, shapely, and the formulas. ``random_parts``, ``random_domains`` and
``random_surfaces`` draw things to mesh: pure functions of (seed, number). ``judged_meshes`` meshes
one, and sets the judge's verdict beside the report's.
"""
