"""The report as text.

summary: the verdict first, then one line for each thing a user asks about.
certificate: the report in full: the summary, then tables of faces, solids and worst triangles.
"""
