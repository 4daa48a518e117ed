"""Swaps, smoothing, collapse and split, measured on the surface."""
