"""Shapes that live in this process: CadQuery and others, with their tags.

from_cadquery: shapes that live in this process: CadQuery, build123d, or OCP's own.
tags: what tags of CadQuery stand for in the final shape, which later steps may have made anew.
motions: by which motion one shape came out of another: a copy that is moved keeps its parts' order.
"""
