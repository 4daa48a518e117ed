"""CAD models as plain data. The only package that knows OCP, which it imports when it is needed.

model, invariants, loops   vertices, edges, faces and solids by number; no OCP
convert                    geometry of OCP -> plain curves and surfaces of `geometry`
topology                   shapes of OCP -> `CadModel`
"""
