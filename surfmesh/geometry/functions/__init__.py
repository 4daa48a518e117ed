"""Surfaces given by a Python function.

numeric: the surface, with derivatives that the caller gives or that differences give.
differences: partial derivatives by differences that never leave the domain.
"""
