"""The mesh as a value: points and triangles, how they hang together, what they stand for.

connectivity: which triangles meet along which edges: unique edges and twins, from the triangles
    alone.
findings: what went wrong, as records: kind, face, place and reason; the sentence is made at the
    end.
mesh_groups: what a mesh knows of its faces, solids and edges besides numbers: plain data, no CAD.
model_facts: what is known of a model beforehand: what its mesh is compared with. Plain data, no
    CAD.
quadratic_triangles: triangles of six nodes: corners, and one node amid each edge, shared by its
    triangles.
mesh_part: arrays that say of themselves what their rows stand for: how they are checked, cut
    down to a part and numbered anew.
mesh_parts: what a mesh holds besides points and triangles: Parametrisation, ModelLinks,
    EdgeLinks, Record.
mesh_fields: all fields by one name each: keywords of a mesh.
part_attributes: what the parts hold, as attributes of a mesh, each with its docstring.
invariants: what has to hold of every mesh: the first thing that does not.
surface_mesh: the result: an immutable triangle mesh on one or more surfaces.
curved_fit: how far the quadratic triangles of a mesh lie from its surfaces, arcs from its curves.
facets: quadratic triangles as flat ones.

Others use all of them but mesh_part, mesh_fields, part_attributes and invariants; mesh_part is
for what adds triangles to a mesh too.
"""
