"""What is measured in three dimensions and not yet in the compiled core.

nurbs: b-spline curves and surfaces, rational or not, with derivatives up to the third order.
"""
