"""As a meshio.Mesh, for the formats that surfmesh does not write itself."""

from typing import TYPE_CHECKING

from surfmesh.quality.shape import alpha
from surfmesh.surface_mesh import SurfaceMesh

if TYPE_CHECKING:
    import meshio


def to_meshio(mesh: SurfaceMesh) -> "meshio.Mesh":
    """meshio.Mesh with point data ``size``, cell data ``face_id`` and ``alpha``.

    Raises ``ImportError`` that says what to install when meshio is not there.
    """
    try:
        import meshio
    except ImportError:
        raise ImportError("to_meshio needs meshio: pip install meshio") from None
    return meshio.Mesh(
        mesh.points.copy(),
        [("triangle", mesh.triangles.copy())],
        point_data={} if mesh.sizes is None else {"size": mesh.sizes.copy()},
        cell_data={"face_id": [mesh.face_ids.copy()], "alpha": [alpha(mesh)]},
    )
