"""Where r(u, v) comes from: surfaces and domains, their derivatives, closest points and sides.

Used by others: all that is listed here; of the folders the modules that are in brackets.

surface         what every surface can do, and what it may say of itself
core_surface    how a surface of Python becomes one of the compiled core
surface_checks  what a surface over a rectangle is refused for, however its points are made
formulas        surfaces of formulas (parametric, kinks, interval)
functions       surfaces of Python functions (numeric)
cad_surfaces    curves and surfaces of CAD (all of it)
planar          domains of the plane (planar_domain, curve_contacts, curve_circles,
                segment_distance)
files           formula files and domain files (surface_file, formula_file, known_facts)
differential    forms, curvatures, charts, sides, closest points (all of it)
inside_loops    which points lie within loops, and how many loops lie around a loop
rings           closed polygons: the area that one runs round
boxes           boxes around points
parameter_grid  a grid of parameters all over a domain
components      which things hang together
quadrature      Gauss's rule on an interval
interpolating_spline  splines through points
small_matrices  products and decompositions of small matrices, the same bits on every processor
number_range    which numbers can be computed with
text_file       files of text, as they may come from anywhere
"""
