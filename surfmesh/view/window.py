"""Interactive windows, and widgets in notebooks."""

import os
import sys

from surfmesh.errors import SurfmeshError
from surfmesh.surface_mesh import SurfaceMesh
from surfmesh.view.colouring import colouring
from surfmesh.view.legend import title_of, with_edges
from surfmesh.view.overlays import overlays
from surfmesh.view.scene import scene

SIZE = (1200, 900)  # pixels


def show(
    mesh: SurfaceMesh,
    *,
    by: str = "alpha",
    edges: bool | None = None,
    circles: bool = False,
    directions: bool = False,
    worst: int | None = None,
    title: str | None = None,
) -> None:
    """Open a window to turn and zoom ``mesh``; in a notebook, a widget.

    Everything as in ``plot``. Returns when the window is closed. Raises ``SurfmeshError`` when
    there is no display.
    """
    in_notebook = "ipykernel" in sys.modules
    displays = ("DISPLAY", "WAYLAND_DISPLAY")
    if sys.platform == "linux" and not in_notebook and not any(map(os.environ.get, displays)):
        raise SurfmeshError("there is no display to open a window on; write a picture instead")
    plotter = scene(
        mesh,
        colouring(mesh, by),
        overlays(mesh, by, draw_circles=circles, directions=directions, worst=worst),
        title=title_of(mesh) if title is None else title,
        edges=with_edges(mesh, edges),
        size=SIZE,
        off_screen=in_notebook,
    )
    plotter.show()
