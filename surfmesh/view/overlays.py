"""Which lines go over the colours of a picture."""

from surfmesh.result.surface_mesh import SurfaceMesh
from surfmesh.view.lines import Lines, circles, model_edges, principal_directions, worst_triangles

MARKED = 10  # triangles that are outlined where shape is shown
SHAPES = ("alpha", "angle", "quality")


def overlays(
    mesh: SurfaceMesh, by: str, *, draw_circles: bool, directions: bool, worst: int | None
) -> list[Lines]:
    """Edges of the model always, the rest as asked for; the last is drawn over the others.

    worst: how many triangles of the smallest alpha are outlined; None: a few where the colours
    show shape. Raises ``ValueError`` for what the mesh carries no data for.
    """
    layers = [circles(mesh)] if draw_circles else []
    layers += principal_directions(mesh) if directions else ()
    layers.append(model_edges(mesh))
    count = (MARKED if by in SHAPES else 0) if worst is None else worst
    if count > 0:
        marked, numbers = worst_triangles(mesh, count)
        layers.append(marked._replace(name=f"the {len(numbers)} worst triangles"))
    return [layer for layer in layers if len(layer.segments)]


def legend(layers: list[Lines]) -> list[Lines]:
    """Those that need a word: what is black is an edge."""
    return [layer for layer in layers if layer.name not in ("model edges", "sides")]
