"""Meshes to files and back. The extension says the format; see ``FORMATS``."""

from surfmesh.io.formats import FORMATS, read, save
from surfmesh.io.manifests import Entry, Manifest

__all__ = ["FORMATS", "Entry", "Manifest", "read", "save"]
