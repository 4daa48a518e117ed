"""Shapes that live in this process: CadQuery and others, with their tags.

from_cadquery: the model of an object of CadQuery, build123d or OCP (for others).
parts_of_objects: objects -> parts: what each of them calls a name, a colour, a place.
tags: what tags of CadQuery stand for in the final shape, which later steps may have made anew.
motions: by which motion one shape came out of another: a copy that is moved keeps its parts' order.
"""
