"""What the user asks for.

sizing: what the user asks for: one frozen set of options.
other_words: what other programs call these options.
defaults: what holds where nothing is asked for.
positive: what counts as a size: a finite number above zero.
size_laws: sizes as functions of the place, whoever wrote them: asked for at points, and looked at.
sources: local sizes: near points and lines, within boxes and balls.
size_cloud: sizes at points, growing from each: what another mesh, or a solver, has found.
distance_size: sizes that grow with the distance from lines and points.
radius_laws: what ``pack`` may be given beside a number or a callable: random radii, fields of
    tensors.
sizes_file: sizes by selection in a TOML file.
model_sizing: sizes by name: selections of a CAD model, resolved to the sizes of each face, edge
    and vertex.
given_sizes: the forms in which the verbs take sizes, and the options that are made of them.
"""
