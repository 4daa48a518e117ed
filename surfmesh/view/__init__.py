"""Pictures of a mesh: PNG files without a display, interactive windows, reports in HTML.

vertex_parameters: one surface and one (u, v) for every vertex.
faces_apart: vertices doubled where faces meet, for what jumps there.
colouring, colour_maps: what a mesh can be coloured by, and the colours.
lines, overlays: lines over the colours, and which of them are drawn.
legend, camera: what is written around them, and from where the mesh is looked at.
drawing: all of that for one picture, however it is drawn.
scene, opengl, painter: it is drawn by VTK, where VTK can draw here, or else painted.
picture: PNG files.
window, notebook: interactive windows, and widgets in notebooks.
page_data, histogram, certificate_html, html_report: the report as one HTML file.
summary_html: what a notebook shows for a mesh.
packing_drawing: a circle packing as SVG or PNG.

Others use what is named below, ``packing_drawing``, ``summary_html`` and ``legend``.
"""

from surfmesh.view.html_report import html_report
from surfmesh.view.picture import plot
from surfmesh.view.window import show

__all__ = ["html_report", "plot", "show"]
