"""Interactive windows, and widgets in notebooks."""

import os
import sys
from typing import Unpack

from surfmesh.errors import SurfmeshError, needs
from surfmesh.result.surface_mesh import SurfaceMesh
from surfmesh.view.drawing import Look, drawing
from surfmesh.view.overlays import SHAPES

SIZE = (1200, 900)  # pixels


def show(mesh: SurfaceMesh, **look: Unpack[Look]) -> None:
    """Open a window to turn and zoom ``mesh``; in a notebook, a widget.

    Everything as in ``plot``. Returns when the window is closed. Raises ``SurfmeshError`` when
    there is no display.
    """
    if _in_notebook():
        _show_page(mesh, look)
        return
    displays = ("DISPLAY", "WAYLAND_DISPLAY")
    if sys.platform == "linux" and not any(map(os.environ.get, displays)):
        raise SurfmeshError("there is no display to open a window on; write a picture instead")

    with needs("view", "a window"):
        from surfmesh.view.scene import scene

    scene(drawing(mesh, SIZE, **look), off_screen=False).show()


def _in_notebook() -> bool:
    """Does this code run in the kernel of a notebook? That the module is there says nothing."""
    shell = getattr(sys.modules.get("IPython"), "get_ipython", lambda: None)()
    return hasattr(shell, "kernel")


def _show_page(mesh: SurfaceMesh, look: Look) -> None:
    from surfmesh.view.html_report import page
    from surfmesh.view.notebook import show_in_notebook

    by, worst = look.get("by", "alpha"), look.get("worst")
    switches = {
        "triangles": look.get("edges") is not False,  # the page fades them where they are too many
        "model edges": True,
        "circles": look.get("circles", False),
        "principal directions": look.get("directions", False),
        "worst": by in SHAPES if worst is None else worst > 0,
    }
    shown = [name for name, is_on in switches.items() if is_on]
    show_in_notebook(page(mesh, by=by, title=look.get("title"), shown=shown))
