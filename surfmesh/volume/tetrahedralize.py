"""Fill the solids of a closed surface mesh with tetrahedra."""

from importlib import import_module

import numpy as np
from numpy.typing import NDArray

from surfmesh.errors import MeshingError
from surfmesh.result.quadratic_triangles import edge_rows
from surfmesh.result.surface_mesh import SurfaceMesh
from surfmesh.volume.solid_regions import positive, solids_of_tetrahedra
from surfmesh.volume.untangling import untangled
from surfmesh.volume.volume_mesh import LEGS, VolumeMesh

ENGINES = {
    "tetgen": "surfmesh.volume.by_tetgen",
    "gmsh": "surfmesh.volume.by_gmsh",
    "netgen": "surfmesh.volume.by_netgen",
    "ftetwild": "surfmesh.volume.by_ftetwild",
}
"""Programs that fill, and the modules that ask them."""

SAME_VOLUME = 1e-9  # of the tetrahedra and of the surface around them, relative


def tetrahedralize(
    mesh: SurfaceMesh,
    engine: str = "tetgen",
    *,
    size: float | None = None,
    order: int | None = None,
) -> VolumeMesh:
    """Tetrahedra inside the solids of ``mesh``, on its triangles as they are.

    engine: ``tetgen``, ``gmsh``, ``netgen`` (each needs its own package), or ``ftetwild``, which
    accepts any surface but makes a new one near it, which the mesh's ``warnings`` say. size:
    largest edge inside, in model units; without it tetrahedra grow as the engine lets them.
    order: 2 for middles of edges, those of the surface where it has some; default: that of the
    mesh. Where a curved surface turns tetrahedra inside out, inner nodes move and some tetrahedra
    are split; those whose Jacobian is not proved positive then are counted in ``warnings``.

    Regions are those of ``solid_ids``; a mesh without solids that is closed is one. Every triangle
    is found again as a side of a tetrahedron on the side where its solid lies, and volumes agree
    with that of the surface, or ``MeshingError`` says what is wrong. Raises ``ImportError`` where
    the engine is not installed and ``ValueError`` for one that is not known.
    """
    if engine not in ENGINES:
        raise ValueError(f"engine must be one of {', '.join(ENGINES)}, not {engine!r}")
    if order not in (None, 1, 2):
        raise ValueError(f"order must be 1 or 2, not {order!r}")
    if size is not None and not size > 0.0:
        raise ValueError(f"size must be positive, not {size!r}")
    order = mesh.order if order is None else order
    surface = _closed(mesh)
    warnings: tuple[str, ...] = ()
    module = import_module(ENGINES[engine])
    if hasattr(module, "fill_near"):
        surface, points, tetrahedra, warning = module.fill_near(surface, size)
        warnings = (warning,)
    else:
        points, tetrahedra = module.fill(surface, size)
    tetrahedra = positive(points, tetrahedra)
    solids = np.asarray(surface.solid_ids)
    inside = solids_of_tetrahedra(tetrahedra, surface.triangles, solids)
    tetrahedra, own = tetrahedra[inside >= 0], inside[inside >= 0]
    points, tetrahedra = _used(points, tetrahedra, len(surface.points))
    if order == 1:
        surface = surface if surface.order == 1 else surface.replaced(mid_points=None)
        nodes, elements = points, tetrahedra
    else:
        surface = surface if surface.order == 2 else _with_middles(surface)
        nodes, elements = _ten_nodes(surface, points, tetrahedra)
        nodes, elements, own, left = untangled(nodes, elements, own, len(surface.nodes))
        if left:
            warnings += (
                f"{left} curved tetrahedra may be turned inside out in a part: their Jacobian "
                "is not proved positive; finer triangles there mend it",
            )
    found = VolumeMesh(
        nodes=np.ascontiguousarray(nodes), elements=elements.astype(np.int32), solid_ids=own,
        surface=surface, engine=engine, warnings=warnings,
    )  # fmt: skip
    _require_volume(found, surface, solids)
    return found


def _closed(mesh: SurfaceMesh) -> SurfaceMesh:
    """The mesh with solids on the sides of its triangles."""
    if mesh.solid_ids is None or not (mesh.solid_ids >= 0).any():
        if len(mesh.boundary_edges) or mesh.one_sided:
            count = len(mesh.boundary_edges)
            raise MeshingError(f"the mesh encloses nothing: {count} edges bound one triangle only")
        volume = _enclosed(mesh, np.ones(len(mesh.triangles)))
        sides = np.full((len(mesh.triangles), 2), -1, np.int32)
        sides[:, 0 if volume > 0.0 else 1] = 0
        mesh = mesh.replaced(solid_ids=sides)
    return mesh


def _enclosed(mesh: SurfaceMesh, signs: NDArray) -> float:
    """Volume inside triangles, from the first point on; signs (m,): -1 for what is turned."""
    a, b, c = (mesh.points[corner] - mesh.points[0] for corner in mesh.triangles.T)
    return float((signs * np.einsum("ij,ij->i", np.cross(a, b), c)).sum() / 6.0)


def _used(points: NDArray, tetrahedra: NDArray, kept: int) -> tuple[NDArray, NDArray]:
    """Without the points that no tetrahedron has, but with the first ``kept``."""
    there = np.zeros(len(points), bool)
    there[:kept] = True
    there[tetrahedra] = True
    return points[there], (np.cumsum(there) - 1)[tetrahedra]


def _with_middles(surface: SurfaceMesh) -> SurfaceMesh:
    return surface.replaced(mid_points=surface.points[surface.edges].mean(axis=1))


def _ten_nodes(
    surface: SurfaceMesh, points: NDArray, tetrahedra: NDArray
) -> tuple[NDArray, NDArray]:  # fmt: skip
    """Nodes and rows of ten: edges of the surface have its middles, the others straight ones.

    Corners keep their numbers on the surface; inner points follow its middles.
    """
    n = len(surface.points)
    legs = np.sort(tetrahedra[:, LEGS].reshape(-1, 2), axis=1)
    edges, inverse = np.unique(legs, axis=0, return_inverse=True)
    row = np.full(len(edges), -1)
    on_surface = (edges < n).all(axis=1)
    row[on_surface] = edge_rows(surface.connectivity, edges[on_surface])
    inner = row < 0
    first = n + len(surface.edges)  # of the inner points
    nodes = np.concatenate((surface.nodes, points[n:], points[edges[inner]].mean(axis=1)))
    number = np.where(inner, first + len(points) - n - 1 + np.cumsum(inner), n + row)
    corners = np.where(tetrahedra < n, tetrahedra, tetrahedra + len(surface.edges))
    return nodes, np.hstack((corners, number[inverse.reshape(-1)].reshape(-1, 6)))


def _require_volume(found: VolumeMesh, surface: SurfaceMesh, solids: NDArray) -> None:
    for solid in np.unique(solids[solids >= 0]).tolist():
        signs = (solids[:, 0] == solid).astype(float) - (solids[:, 1] == solid)
        outside = _enclosed(surface, signs)
        inside = float(found.volumes[found.solid_ids == solid].sum())
        if not abs(inside - outside) <= SAME_VOLUME * abs(outside):
            label = surface.groups.solid_label(solid)
            raise MeshingError(f"{label}: tetrahedra fill {inside:.6g} of {outside:.6g}")
