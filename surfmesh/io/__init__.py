"""Meshes to files and back. The extension says the format; see ``FORMATS``."""

from surfmesh.io.formats import FORMATS, read, save

__all__ = ["FORMATS", "read", "save"]
