"""The paper in Python."""
