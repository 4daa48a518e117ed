"""Slow, obvious twins of the kernels, and checks that name the first broken invariant."""
