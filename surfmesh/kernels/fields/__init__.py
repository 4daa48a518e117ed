"""Size tensors, their gradation, and the look-up in a background.

background: look-up in the background: size tensors on a forest of quadtrees over the (x, y) box.
coverage: the metric area that a background gives to a rectangle: how many circles will cover it.
gradation: gradation and accuracy of a size field on patches of nine nodes.
source_tree: a background from points of known size, over a plane whose metric is constant.
tensors: algebra of size tensors H = (h11, h12, h22) and metric lengths; see kernels/__init__.
axis_bending: evaluation of the monotone cubic that bends one axis of the scaled plane.
"""
