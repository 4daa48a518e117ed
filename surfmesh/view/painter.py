"""A picture without OpenGL: triangles sorted by depth and painted from back to front.

For machines where VTK cannot draw (a bare container without libEGL). Slower than a graphics
card and wrong only where triangles pierce each other.
"""

from typing import BinaryIO

import numpy as np
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.cm import ScalarMappable
from matplotlib.collections import PolyCollection
from matplotlib.colors import LogNorm, Normalize, to_rgba
from matplotlib.figure import Figure
from numpy.typing import NDArray

from surfmesh.geometry.boxes import diagonal
from surfmesh.view.camera import Camera, framed
from surfmesh.view.colour_maps import map_of
from surfmesh.view.drawing import Drawing, face_legend
from surfmesh.view.legend import INK
from surfmesh.view.overlays import legend

DOTS_PER_INCH = 100
HAIRLINE = 0.25  # points
NEARER = 0.012  # of the mesh's diagonal: lines hide what is less than this before them


def paint(drawn: Drawing, file: BinaryIO) -> None:
    """Write a PNG to ``file``."""
    mesh, colours, size = drawn.mesh, drawn.colours, drawn.size
    figure = Figure(figsize=(size[0] / DOTS_PER_INCH, size[1] / DOTS_PER_INCH), dpi=DOTS_PER_INCH)
    canvas = FigureCanvasAgg(figure)
    axes = figure.add_axes((0.02, 0.12, 0.96, 0.82))
    camera = framed(mesh.points, size[0] * 0.96 / (size[1] * 0.82))

    scale = ScalarMappable(
        (LogNorm if colours.logarithmic else Normalize)(*colours.limits), map_of(colours)
    )
    axes.add_collection(_painted(drawn, camera, scale))
    half_width = camera.half_height * size[0] * 0.96 / (size[1] * 0.82)
    axes.set(xlim=(-half_width, half_width), ylim=(-camera.half_height, camera.half_height))
    axes.set_aspect("equal")
    axes.axis("off")
    figure.text(0.02, 0.955, drawn.title, color=INK, fontsize=11)
    said = [(layer.name, layer.colour) for layer in legend(drawn.lines)]
    said += [(f"{face}: {name}", colour) for face, name, colour in face_legend(drawn)]
    for row, (text, colour) in enumerate(said, 1):
        figure.text(0.02, 0.955 - 0.03 * row, text, color=colour, fontsize=9)
    bar = figure.colorbar(
        scale, cax=figure.add_axes((0.25, 0.075, 0.5, 0.025)), orientation="horizontal"
    )
    bar.set_label(colours.title, color=INK)
    if colours.hues:
        bar.set_ticks(range(colours.hues))
    canvas.print_png(file, metadata={"Software": None})  # the same with any version


def _painted(drawn: Drawing, camera: Camera, scale: ScalarMappable) -> PolyCollection:
    """Triangles and lines, from back to front."""
    mesh, colours, triangles = drawn.mesh, drawn.colours, drawn.mesh.triangles
    seen, depth = _seen(mesh.points, camera)
    values = colours.within
    values = values[triangles].mean(axis=1) if colours.per_vertex else values
    faces = scale.to_rgba(values)
    # its own colour closes the hairlines
    rims = np.tile(to_rgba(INK), (len(faces), 1)) if drawn.edges else faces
    widths = np.full(len(faces), HAIRLINE)
    depth = depth[triangles].mean(axis=1)
    corners = seen[triangles]
    # a line is a triangle without area, a little nearer than what it lies on
    for layer in drawn.lines:
        ends, behind = _seen(layer.segments, camera)
        corners = np.concatenate((corners, ends[:, [0, 1, 1]]))
        reach = NEARER * diagonal(mesh.points)
        depth = np.concatenate((depth, behind.max(axis=1) + reach))
        colour = np.tile(to_rgba(layer.colour), (len(ends), 1))
        faces, rims = np.concatenate((faces, colour)), np.concatenate((rims, colour))
        pixels = layer.width * drawn.size[1] / 1000
        widths = np.concatenate((widths, np.full(len(ends), pixels * 72 / DOTS_PER_INCH)))
    order = np.argsort(depth, kind="stable")
    return PolyCollection(
        corners[order],  # type: ignore[arg-type]  # its stubs know no arrays
        facecolors=faces[order],
        edgecolors=rims[order],
        linewidths=widths[order],
    )


def _seen(points: NDArray, camera: Camera) -> tuple[NDArray, NDArray]:
    """Points (..., 3) in the picture (..., 2), and how near they are to the eye (...)."""
    relative = points - camera.centre
    across, along = relative @ camera.right, relative @ camera.up
    return np.stack((across, along), axis=-1), relative @ camera.towards
