"""Size tensors and the look-up in a background, for the kernels that are not in the core yet.

background: look-up in the background: size tensors on a forest of quadtrees over the (x, y) box.
tensors: algebra of size tensors H = (h11, h12, h22) and metric lengths; see kernels/__init__.
"""
