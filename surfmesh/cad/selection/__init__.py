"""Faces, edges and solids of a model by name, number, colour, kind or selector.

selection: faces, edges, vertices and solids of a model by name, number, colour, kind or selector.
selectors: CadQuery's string selectors, evaluated on a plain model.
"""
