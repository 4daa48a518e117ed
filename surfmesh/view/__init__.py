"""Pictures of a mesh: PNG files without a display, and interactive windows."""

from surfmesh.view.picture import plot
from surfmesh.view.window import show

__all__ = ["plot", "show"]
