"""Where r(u, v) comes from: surfaces, their forms and curvatures, sides, closest points.

surface             what every surface can do
expression          formulas as data: text -> SymPy, through a whitelist
real_functions      abs, min, cbrt ... with real derivatives
derivatives         the chain rule over shared subexpressions
compilation         SymPy -> tape
tape, interval      evaluation at points, bounds over cells
parametric          the surface of three formulas
formula_file        surfaces in TOML, the gallery of them
planar_domain       loops, holes, constraints in the plane
segment_graph       their segments, which meet at common ends only; what is inside
noding              cutting segments where they meet
domain_faces        the regions as polygons
nesting             which loop lies in which
segment_distance    exact distances to segments
svg_paths, shapely_parts    drawings and geometries as arrays
domain_file         planar domains in TOML
toml_entries        entries of a TOML file, with errors that name the key
surface_file        any file of a surface or domain, the whole gallery
formula_file        surfaces in TOML, the gallery
plain_data          frozen, picklable dataclasses of arrays
curves              what every curve can do; lines and conics, in space and in the plane
face_surface        what the surfaces of CAD faces have in common
elementary          plane, cylinder, cone, sphere, torus
nurbs               B-spline and Bezier curves and surfaces
swept               surfaces of extrusion and revolution
offset              curves and surfaces at a distance from others
fundamental_forms   I, II, normals, principal curvatures
sides               sides of the rectangle that coincide or shrink to a point
projection          the closest point of a surface
chart               the scaled parameter plane, its axes bent to even speeds
"""
