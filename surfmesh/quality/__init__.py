"""Is the mesh any good: shape, lengths, topology, deviation, and the report of them all."""

from surfmesh.quality.report import Report, check

__all__ = ["Report", "check"]
