"""
Section 3 of the paper: boundary nodes and segments by tracing neighbours.
"""
