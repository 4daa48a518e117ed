"""Curves and surfaces of CAD faces, evaluated without OCP.

plain_data: frozen dataclasses of numbers and read-only arrays, which travel between processes.
curves: what every curve can do, in space and in the plane; lines and conics.
face_surface: what the surfaces of CAD faces have in common: a parameter box, periods.
elementary: plane, cylinder, cone, sphere and torus, parametrised as CAD kernels do.
nurbs: B-spline curves and surfaces, rational or not; Bezier ones are B-splines of one span.
offset: curves and surfaces at a fixed distance from others, with exact derivatives.
elementary_offsets: offsets of elementary surfaces that are elementary themselves.
swept: surfaces that a curve sweeps: along a line, or round an axis.
sheet_surface: a surface of formulas, or of a caller's function, as that under a face.
curve_on_surface: a curve in space that a surface makes of a p-curve.
singular_lines: lines u = c or v = c of a face's surface that are one point in space.
"""
