"""CAD models: the only part that knows OCP, which it imports where it is needed.

convert             geometry of OCP -> plain curves and surfaces of `geometry`
"""
