"""Which rule decides the size at a point: the same rules as those of the size field.

nearest_place: the place on a surface, or on the faces of a model, that is nearest to a point.
size_row: one line of an explanation: a rule, whose it is, and the size that it asks for.
askers: whose a rule is: the keys of sizes by selection.
rulings: what the rules of a surface say at one point, and which of them decides.
axis_sizes: sizes that depend on the direction: the rule along each axis of the metric.
origins: where sizes grow from, on faces and on edges.
explanation: all of it together; what others use.
"""
