"""Surfaces given by formulas: text to expressions, to tapes of numbers and intervals.

expression: formulas as data: text to SymPy expressions through a whitelist, nothing executed as
    Python.
compilation: from SymPy expressions to a tape, with derivatives.
chain_rule: derivatives of straight-line programs, step by step: forward differentiation.
derivatives: partial derivatives of formulas by the chain rule over shared subexpressions.
program: straight-line programs: values numbered by what computes them, constants folded, and from.
tape: a tape: a straight-line program of numpy operations, for points and for intervals.
interval: interval arithmetic on arrays: a function of an interval is an interval that holds its
    range.
real_functions: functions of real variables for SymPy, differentiable almost everywhere.
parametric: surfaces given by three formulas in u and v.
kinks: lines in (u, v) along which a formula surface is bent sharply: kinks of abs, max, min and
    sign.
"""
