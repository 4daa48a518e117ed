"""A whole (u, v) domain and its size field become triangles in one call."""
