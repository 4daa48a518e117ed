"""The figures of the report in parts, as data: each part takes its own from the measurements.

part: what a part is.
counts: names and numbers of what was looked at.
topology: what kind of surface the triangles form, and where they meet that should not.
shape: the shape of the triangles, and how they are turned against the surface.
sizes: edge lengths, against the target sizes and against each other.
accuracy: how closely the mesh follows its surfaces.
area_and_volume: area and volume beside those of the model.
provenance: what a mesh was made with, and a fingerprint of what came out.
proof: what is proved of the mesh; filled in on request.
second_opinion: what other libraries say; ``opinion`` fills it in.
figures: all parts and findings together, each figure as an attribute, and as JSON.

``io`` uses ``provenance``; the others are read through ``Report``.
"""
