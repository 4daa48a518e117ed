"""A picture without OpenGL: triangles sorted by depth and painted from back to front.

For machines where VTK cannot draw (a bare container without libEGL). Slower than a graphics
card and wrong only where triangles pierce each other.
"""

from pathlib import Path

import numpy as np
from matplotlib import colormaps
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.cm import ScalarMappable
from matplotlib.collections import PolyCollection
from matplotlib.colors import LogNorm, Normalize
from matplotlib.figure import Figure

from surfmesh.surface_mesh import SurfaceMesh
from surfmesh.view.camera import framed
from surfmesh.view.colouring import Colouring
from surfmesh.view.legend import INK, title_of

AMBIENT = 0.35  # light from everywhere; the rest comes from the eye
DOTS_PER_INCH = 100


def paint(
    mesh: SurfaceMesh,
    colours: Colouring,
    path: Path,
    *,
    edges: bool,
    size: tuple[int, int],
) -> None:
    """Write a PNG of ``mesh`` to ``path``, ``size`` (width, height) in pixels."""
    figure = Figure(figsize=(size[0] / DOTS_PER_INCH, size[1] / DOTS_PER_INCH), dpi=DOTS_PER_INCH)
    canvas = FigureCanvasAgg(figure)
    axes = figure.add_axes((0.02, 0.12, 0.96, 0.82))
    camera = framed(mesh.points, size[0] * 0.96 / (size[1] * 0.82))

    relative = mesh.points - camera.centre
    seen = np.column_stack((relative @ camera.right, relative @ camera.up))
    depth = (relative @ camera.towards)[mesh.triangles].mean(axis=1)
    order = np.argsort(depth)
    triangles = mesh.triangles[order]
    a, b, c = (mesh.points[corner] for corner in triangles.T)
    normals = np.cross(b - a, c - a)
    lengths = np.linalg.norm(normals, axis=1)
    facing = np.abs(normals @ camera.towards) / np.where(lengths > 0, lengths, 1.0)
    values = colours.values
    values = values[triangles].mean(axis=1) if colours.per_vertex else values[order]

    norm = (LogNorm if colours.logarithmic else Normalize)(*colours.limits)
    scale = ScalarMappable(norm, colormaps[colours.colours])
    painted = scale.to_rgba(values)
    painted[:, :3] *= (AMBIENT + (1 - AMBIENT) * facing)[:, None]
    axes.add_collection(
        PolyCollection(
            seen[triangles],
            facecolors=painted,
            edgecolors=INK if edges else painted,  # its own colour closes the hairlines
            linewidths=0.25,
        )
    )
    half_width = camera.half_height * size[0] * 0.96 / (size[1] * 0.82)
    axes.set(xlim=(-half_width, half_width), ylim=(-camera.half_height, camera.half_height))
    axes.set_aspect("equal")
    axes.axis("off")
    figure.text(0.02, 0.955, title_of(mesh), color=INK, fontsize=11)
    bar = figure.colorbar(
        scale, cax=figure.add_axes((0.25, 0.075, 0.5, 0.025)), orientation="horizontal"
    )
    bar.set_label(colours.title, color=INK)
    canvas.print_png(path)
