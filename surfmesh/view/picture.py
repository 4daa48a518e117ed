"""PNG files, with no display and no window."""

from pathlib import Path

from surfmesh.errors import FileFormatError
from surfmesh.io.atomic import replacing
from surfmesh.surface_mesh import SurfaceMesh
from surfmesh.view.colouring import Colouring, colouring
from surfmesh.view.legend import with_edges
from surfmesh.view.opengl import can_draw

SIZE = (1600, 1200)  # pixels


def plot(
    mesh: SurfaceMesh,
    path: str | Path,
    *,
    by: str = "alpha",
    edges: bool | None = None,
    size: tuple[int, int] = SIZE,
) -> Path:
    """Write a PNG of ``mesh`` to ``path`` and return the path.

    by: "alpha" (shape), "size" (wanted), "deviation", "face" or "curvature". edges: draw
    them; None draws them when there are not too many. size: width and height in pixels.

    Where no OpenGL can be used the picture is painted triangle by triangle. Raises
    ``FileFormatError`` for a place that cannot be written or an extension other than .png,
    ``ValueError`` for an unknown ``by`` or one that the mesh has no data for.
    """
    path = Path(path)
    if path.suffix.lower() != ".png":
        raise FileFormatError(f"{path}: pictures are written as .png, not '{path.suffix}'")
    if not len(mesh.triangles):
        raise FileFormatError(f"{path}: nothing to draw, the mesh has no triangles")
    colours = colouring(mesh, by)
    with replacing(path) as temporary:
        draw = _render if can_draw() else _paint
        draw(mesh, colours, temporary, with_edges(mesh, edges), size)
    return path


def _render(
    mesh: SurfaceMesh, colours: Colouring, path: Path, edges: bool, size: tuple[int, int]
) -> None:
    import pyvista

    from surfmesh.view.scene import scene

    with pyvista.vtk_verbosity("off"):  # it says on the console that there is no display
        plotter = scene(mesh, colours, edges=edges, size=size, off_screen=True)
        try:
            plotter.screenshot(path)
        finally:
            plotter.close()


def _paint(
    mesh: SurfaceMesh, colours: Colouring, path: Path, edges: bool, size: tuple[int, int]
) -> None:
    from surfmesh.view.painter import paint

    paint(mesh, colours, path, edges=edges, size=size)
