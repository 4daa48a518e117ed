"""PNG files, with no display and no window."""

from io import BytesIO
from pathlib import Path
from typing import Unpack

from surfmesh.errors import FileFormatError, needs
from surfmesh.io.atomic import replacing
from surfmesh.result.surface_mesh import SurfaceMesh
from surfmesh.view.drawing import Drawing, Look, drawing
from surfmesh.view.legend import require_drawable
from surfmesh.view.opengl import can_draw

SIZE = (1600, 1200)  # pixels


def plot(
    mesh: SurfaceMesh,
    path: str | Path,
    *,
    size: tuple[int, int] = SIZE,
    **look: Unpack[Look],
) -> Path:
    """Write a PNG of ``mesh`` to ``path`` and return the path.

    by: "alpha" (the default) or "quality" (shape), "angle", "size" (wanted), "deviation", "face",
    "curvature", "gaussian" or "mean". edges: draw those of the triangles; None draws them when
    there are not too many, and no circles. circles: draw the packing on the surface, a circle
    of the wanted size around every vertex. directions: draw the principal directions. worst:
    how many triangles of the worst shape are outlined; None: ten where the colours show shape.
    Edges of CAD models, boundaries and borders between faces are always drawn. title: the line
    on top; None: name, counts and shape. size: width and height in pixels.

    Where no OpenGL can be used the picture is painted triangle by triangle. Raises
    ``FileFormatError`` for a place that cannot be written or an extension other than .png,
    ``ValueError`` for an unknown ``by`` or what the mesh has no data for.
    """
    path = Path(path)
    if path.suffix.lower() != ".png":
        raise FileFormatError(f"{path}: pictures are written as .png, not '{path.suffix}'")
    require_drawable(mesh, path)
    drawn = drawing(mesh, size, **look)
    with replacing(path) as temporary:
        picture = BytesIO()
        (_render if can_draw() else _paint)(drawn, picture)
        temporary.write_bytes(picture.getbuffer())
    return path


def _render(drawn: Drawing, file: BytesIO) -> None:
    with needs("view", "a picture"):
        import pyvista

        from surfmesh.view.scene import scene

    with pyvista.vtk_verbosity("off"):  # it says on the console that there is no display
        plotter = scene(drawn, off_screen=True)
        try:
            plotter.screenshot(file)
        finally:
            plotter.close()


def _paint(drawn: Drawing, file: BytesIO) -> None:
    with needs("view", "a picture"):
        from surfmesh.view.painter import paint

    paint(drawn, file)
