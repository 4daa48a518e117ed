"""Edges of a CAD model, each cut once for all its faces.

    samples  ->  what each edge asks for  ->  narrow faces, mates  ->  graded  ->  nodes
                 (rules, near faces)                                   over the model
    later rounds: what the sizes inside faces ask for along the edges comes first

In the order in which data passes:

edge_samples: what is known of the edges of a model before they are cut: samples, narrow faces,
    mates. Plain data, which the others fill.
edge_rules: what is asked of the edges by themselves: the rules at samples of one edge.
narrow_faces: faces that are narrower than the chord all along: two sides, and what joins them at
    the ends.
edge_mates: edges that run side by side are cut with nodes that face each other.
edge_sampling: samples along the edges of a CAD model, and the edge lengths that they ask for by
    themselves.
face_proximity: near faces of a solid: the distance between them as a local size of both.
model_rules: sizes that follow from a model as a whole: from its volumes, and from gaps between its
    faces.
inner_sizes: what the sizes inside a face ask for along its edges, which know their own
    surroundings only.
polygon_lengths: how far along a polygon in space its nodes lie.
edge_gradation: gradation of the edges of a CAD model where sizes depend on the direction.
edge_nodes: the edges of a CAD model, each cut once for all its faces.
"""
