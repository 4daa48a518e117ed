"""As a meshio.Mesh, for the formats that surfmesh does not write itself."""

from typing import TYPE_CHECKING

from surfmesh.errors import needs
from surfmesh.quality.measures.shape import alpha
from surfmesh.result.quadratic_triangles import node_values
from surfmesh.result.surface_mesh import SurfaceMesh

if TYPE_CHECKING:
    import meshio


def to_meshio(mesh: SurfaceMesh) -> "meshio.Mesh":
    """meshio.Mesh with point data ``size``, cell data ``face_id``, ``alpha`` and ``solid_id``.

    Cells are ``triangle``, or ``triangle6`` for order 2. Raises ``MissingExtraError`` where meshio
    is not there.
    """
    with needs("med", "to_meshio"):
        import meshio
    cells = {"face_id": [mesh.face_ids.copy()], "alpha": [alpha(mesh)]}
    if mesh.solid_ids is not None:
        cells["solid_id"] = [mesh.solid_ids.copy()]
    sizes = mesh.sizes
    if sizes is not None and mesh.order == 2:
        sizes = node_values(sizes, mesh.edges)
    return meshio.Mesh(
        mesh.nodes.copy(),
        [("triangle" if mesh.order == 1 else "triangle6", mesh.elements.copy())],
        point_data={} if sizes is None else {"size": sizes.copy()},
        cell_data=cells,
    )
