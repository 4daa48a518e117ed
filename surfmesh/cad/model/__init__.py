"""A CAD model as plain data, without OCP, and what is true of it.

cad_model: a CAD model as plain data: vertices, edges, faces and solids by number, no OCP anywhere.
is_cad_model: is it a CAD model? Asked without importing one.
curve_samples: points of many coedges and edges at once.
invariants: what must be true of a CAD model, and how far a model is from it.
incidence: how often faces use each edge, and how many fans they form at each vertex of a model.
loops: coedges of a face in walking order: which follows which, and what is a loop of its own.
facts: what a CAD model knows of itself and its mesh can be held to: areas, volumes, Euler numbers.
extent: how large a model is, from points on its edges and inside its faces.
centres: centres of faces, edges and solids of a plain model, and samples inside faces.
collapsed_edges: edges so short that the mesh has one vertex in their place, and what becomes of
    their ends.
model_arrays: a model as arrays over all its vertices, edges and coedges.
pcurves: p-curves that follow their edge more closely than those of the file.
near_poles: p-curves that end at a pole which is only nearly a point keep their direction there.
singular_crossings: where faces and their edges cross lines that are one point in space.
singular_cuts: faces are cut along lines inside them that are one point in space: the pinch of a
    torus, an apex.
tolerances: tolerances that are true, and p-curves that keep to them.
loop_curves: the loops of a face as curves in its plane of (u, v), and where these come near to each
    other.
loop_crossings: do loops cross where they come near to each other, and how deep?
empty_loops: loops that leave no inside on their left.
loop_faults: what is wrong with the loops of a face however finely they are cut: decided on their
    curves.
"""
