"""What the user asks for, and the field of size tensors that follows from it.

options         what is asked for: one set of options, local sizes, sizes by selection; defaults
metric_roots    packed symmetric matrices that turn steps into lengths in wanted edges
rules           what each rule asks for at a point: one file a rule, all of them in ``size_rules``
field           the least of all rules at a surface, graded, on a quadtree

Others use ``Sizing`` and ``ModelSizing``, ``SizeRules``, ``SizeField`` with ``size_field`` and
``boundary_field``, and ``SizeLimits``.
"""
