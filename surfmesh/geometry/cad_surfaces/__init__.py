"""Curves and surfaces of CAD faces, evaluated without OCP.

plain_data: frozen dataclasses of numbers and read-only arrays, which travel between processes.
curves: curves in space and in the (u, v) plane: what every curve can do, lines and conics.
curve_on_surface: a curve in space that a surface makes of a p-curve: c(t) = r(u(p), v(p)),
    p linear in t.
face_surface: what the surfaces of CAD faces have in common: a parameter box, periods, plain data.
elementary: plane, cylinder, cone, sphere and torus, parametrised as CAD kernels do.
nurbs: b-spline curves and surfaces, rational or not; Bezier ones are B-splines of one span.
offset: curves and surfaces at a fixed distance from others, with exact derivatives.
swept: surfaces that a curve sweeps: along a line, or round an axis.
singular_lines: lines u = c or v = c of a face's surface that are one point in space.
"""
