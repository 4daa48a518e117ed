"""Meshes to files and back. The extension says the format; see ``FORMATS``."""

from typing import TYPE_CHECKING, Any

from surfmesh.io.formats import FORMATS, read, save

if TYPE_CHECKING:
    from surfmesh.io.manifests import Entry, Manifest

__all__ = ["FORMATS", "Entry", "Manifest", "read", "save"]


def __getattr__(name: str) -> Any:
    """Manifests are imported when they are asked for: they need what judges a mesh."""
    if name in ("Entry", "Manifest"):
        from surfmesh.io import manifests

        return getattr(manifests, name)
    raise AttributeError(f"module 'surfmesh.io' has no attribute {name!r}")
