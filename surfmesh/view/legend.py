"""What is written and drawn around the colours: the title, and whether edges are shown."""

from surfmesh.quality.shape import alpha
from surfmesh.surface_mesh import SurfaceMesh

EDGES_UP_TO = 25_000  # triangles; more would paint the surface black
INK = "#202428"


def title_of(mesh: SurfaceMesh) -> str:
    """One line over the picture: name, counts, shape."""
    names = list(dict.fromkeys(surface.name for surface in mesh.surfaces))
    name = f"{names[0]}: " if len(names) == 1 else ""
    shape = alpha(mesh)
    return (
        f"{name}{len(mesh.triangles):,} triangles, {len(mesh.points):,} nodes; "
        f"alpha mean {shape.mean():.3f}, smallest {shape.min():.3f}"
    )


def with_edges(mesh: SurfaceMesh, wish: bool | None) -> bool:
    """``wish``, or when there is none whether the edges of ``mesh`` can be told apart."""
    return len(mesh.triangles) <= EDGES_UP_TO if wish is None else wish
