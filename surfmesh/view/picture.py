"""PNG files, with no display and no window."""

from io import BytesIO
from pathlib import Path

from surfmesh.errors import FileFormatError
from surfmesh.io.atomic import replacing
from surfmesh.result.surface_mesh import SurfaceMesh
from surfmesh.view.colouring import Colouring, colouring
from surfmesh.view.legend import require_drawable, title_of, with_edges
from surfmesh.view.lines import Lines
from surfmesh.view.opengl import can_draw
from surfmesh.view.overlays import overlays

SIZE = (1600, 1200)  # pixels


def plot(
    mesh: SurfaceMesh,
    path: str | Path,
    *,
    by: str = "alpha",
    edges: bool | None = None,
    circles: bool = False,
    directions: bool = False,
    worst: int | None = None,
    title: str | None = None,
    size: tuple[int, int] = SIZE,
) -> Path:
    """Write a PNG of ``mesh`` to ``path`` and return the path.

    by: "alpha" or "quality" (shape), "angle", "size" (wanted), "deviation", "face",
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
    colours = colouring(mesh, by)
    lines = overlays(mesh, by, draw_circles=circles, directions=directions, worst=worst)
    with replacing(path) as temporary:
        draw = _render if can_draw() else _paint
        said = title_of(mesh) if title is None else title
        picture = BytesIO()
        draw(mesh, colours, lines, picture, said, with_edges(mesh, edges, circles), size)
        temporary.write_bytes(picture.getbuffer())
    return path


def _render(
    mesh: SurfaceMesh, colours: Colouring, lines: list[Lines], file: BytesIO, title: str,
    edges: bool, size: tuple[int, int],
) -> None:  # fmt: skip
    import pyvista

    from surfmesh.view.scene import scene

    with pyvista.vtk_verbosity("off"):  # it says on the console that there is no display
        plotter = scene(mesh, colours, lines, title=title, edges=edges, size=size, off_screen=True)
        try:
            plotter.screenshot(file)
        finally:
            plotter.close()


def _paint(
    mesh: SurfaceMesh, colours: Colouring, lines: list[Lines], file: BytesIO, title: str,
    edges: bool, size: tuple[int, int],
) -> None:  # fmt: skip
    from surfmesh.view.painter import paint

    paint(mesh, colours, lines, file, title=title, edges=edges, size=size)
