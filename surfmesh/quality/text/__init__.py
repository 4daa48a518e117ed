"""The report as text.

certificate: the report in full, as text: the summary, then tables of faces, solids and worst
    triangles.
summary: the report as text: the verdict first, then one line for each thing a user asks about.
"""
