"""Pictures of a mesh: PNG files without a display, interactive windows, reports in HTML."""

from surfmesh.view.html_report import html_report
from surfmesh.view.picture import plot
from surfmesh.view.window import show

__all__ = ["html_report", "plot", "show"]
