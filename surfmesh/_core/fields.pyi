"""Size tensors, their gradation, and the look-up in a background."""
