"""Surfaces given by formulas: text to expressions, to tapes of numbers and intervals.

function_table: the functions and constants that may stand in a formula, by name.
parser: formulas as text: recursive descent, through a whitelist.
expression: formulas as data: text or ready-made SymPy expressions, nothing executed as Python.
domain_bounds: bounds of a domain, which may be formulas without variables.
real_functions: abs, min, cbrt ... for SymPy, differentiable almost everywhere.
derivatives: partial derivatives by the chain rule over shared subexpressions.
program: straight-line programs: values numbered by what computes them, constants folded.
chain_rule: derivatives of such programs, step by step.
compilation: from SymPy expressions to a tape, with derivatives.
tape: a straight-line program of elementary operations, for points and for intervals.
compiled_ahead: the tapes of the gallery, made before anybody asks for them.
interval: bounds of vectors seen along directions.
parametric: the surface of three formulas in u and v.
kink_tracing: where the guides of a formula are zero: lines in (u, v), traced on a grid.
kinks: lines along which such a surface is bent sharply: kinks of abs, max, min and sign.
"""
