"""Surfaces and domains as files.

domain_file: planar domains as TOML files.
formula_file: surfaces as TOML files, and the gallery of them.
surface_file: any file that holds a surface: formulas, a planar domain, a drawing; and the whole
    gallery.
toml_entries: the entries of a TOML file, with errors that name the file and the key.
known_facts: what formula files and domains say of themselves, as ``ModelFacts``.
"""
