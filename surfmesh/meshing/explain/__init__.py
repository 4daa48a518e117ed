"""Which rule decides the size at a point.

explanation: which rule decides the size at a point: all that apply there, and where sizes grow
    from.
axis_sizes: sizes that depend on the direction: the two of the metric at a point, and the rule
    along each.
"""
