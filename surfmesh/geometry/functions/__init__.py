"""Surfaces given by a Python function.

numeric: surfaces given by a Python function instead of formulas.
differences: partial derivatives by differences that never leave the domain.
"""
