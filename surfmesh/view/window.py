"""Interactive windows, and widgets in notebooks."""

import os
import sys

from surfmesh.errors import SurfmeshError
from surfmesh.result.surface_mesh import SurfaceMesh
from surfmesh.view.colouring import colouring
from surfmesh.view.legend import title_of, with_edges
from surfmesh.view.overlays import SHAPES, overlays

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
    if _in_notebook():
        _show_page(mesh, by, edges, circles, directions, worst, title)
        return
    displays = ("DISPLAY", "WAYLAND_DISPLAY")
    if sys.platform == "linux" and not any(map(os.environ.get, displays)):
        raise SurfmeshError("there is no display to open a window on; write a picture instead")

    from surfmesh.view.scene import scene

    plotter = scene(
        mesh,
        colouring(mesh, by),
        overlays(mesh, by, draw_circles=circles, directions=directions, worst=worst),
        title=title_of(mesh) if title is None else title,
        edges=with_edges(mesh, edges, circles),
        size=SIZE,
        off_screen=False,
    )
    plotter.show()


def _in_notebook() -> bool:
    """Does this code run in the kernel of a notebook? That the module is there says nothing."""
    shell = getattr(sys.modules.get("IPython"), "get_ipython", lambda: None)()
    return hasattr(shell, "kernel")


def _show_page(
    mesh: SurfaceMesh, by: str, edges: bool | None, circles: bool, directions: bool,
    worst: int | None, title: str | None,
) -> None:  # fmt: skip
    from surfmesh.view.html_report import page
    from surfmesh.view.notebook import show_in_notebook

    wishes = {
        "triangles": edges is not False,  # the page fades them where they are too many
        "model edges": True,
        "circles": circles,
        "principal directions": directions,
        "worst": by in SHAPES if worst is None else worst > 0,
    }
    shown = [name for name, wish in wishes.items() if wish]
    show_in_notebook(page(mesh, by=by, title=title, shown=shown))
