"""CAD models as plain data. The only package that knows OCP and CadQuery, and only when asked.

``model.py`` is what everything else sees; it needs no OCP, nor does reading the data back.
"""
