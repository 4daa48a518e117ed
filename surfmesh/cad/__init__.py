"""CAD models as plain data. The only package that knows OCP, which it imports when it is needed.

reading, child      a file -> `CadModel`, safely: `read_cad`
limits, lifeline    what a child may cost, and that it ends with its parent
from_cadquery       CadQuery, build123d and OCP objects -> `CadModel`
readers, assembly   what files hold: parts with names, colours and places
healing             repair, in words
joining             what is asked of parts that touch: sewing, imprinting; origins: their names
topology, convert   shapes and geometry of OCP -> plain data
loops               coedges in walking order
tolerances, pcurves how far edges really deviate from their faces, and better p-curves
model, invariants   the data, and what must be true of it
"""
