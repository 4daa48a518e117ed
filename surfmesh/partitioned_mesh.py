"""A .pvtu mesh whose pieces are written where the faces are: no process holds the whole.

model -> edges, here -> faces, meshed by workers into files -> numbers of points, here
                                                            -> pieces, written by workers -> index

The caller keeps the nodes of edges, the triangles at the boundaries of faces, and of each piece a
few sums. Points and triangles have the numbers, and pieces the arrays, that ``pvtu.save`` of the
whole mesh would give them, so that the same mesh is read back.
"""

import hashlib
from concurrent.futures import Executor
from dataclasses import dataclass
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from surfmesh.cad.model.cad_model import CadModel
from surfmesh.errors import MeshingError
from surfmesh.geometry.surface import Surface
from surfmesh.io import pvtu
from surfmesh.io.leftovers import held, is_left
from surfmesh.io.vtk_xml import METRIC, content_of
from surfmesh.io.xml_writing import CELL_IDS, POINT_IDS, Content
from surfmesh.meshing.executors import executor_faults, require_executor
from surfmesh.meshing.faces.face_data import FaceMesh
from surfmesh.meshing.faces.face_state import FaceState
from surfmesh.meshing.faces.face_workers import FaceWorkers
from surfmesh.meshing.faces.partitions import FaceStore, StoredFaceMesh
from surfmesh.meshing.model_mesh import FacesApart, mesh_faces_apart
from surfmesh.meshing.progress import Progress
from surfmesh.meshing.solids.joining import metric_roots
from surfmesh.quality.measures.deviation import deviation
from surfmesh.quality.measures.shape import shapes
from surfmesh.result.mesh_groups import MeshGroups
from surfmesh.result.surface_mesh import SurfaceMesh
from surfmesh.sizing.options.given_sizes import Sizes
from surfmesh.truth_value import truth_value


class PieceSums(NamedTuple):
    """What is known of some faces."""

    triangles: int
    area: float
    alpha_sum: float
    alpha_min: float
    deviation: float
    """The largest from the surfaces."""
    chord_use: float
    """The largest as a fraction of the chord that its face was promised; 0 where none was."""


@dataclass(frozen=True)
class PartitionedMesh:
    """What can be said of a mesh that no process holds: counts, shapes, deviation, findings.

    Whether it is closed and free of self-intersection is not looked at: that takes the whole
    mesh, ``surfmesh check`` of the file.
    """

    path: Path
    pieces: int
    nodes: int
    triangles: int
    area: float
    area_of_model: float
    alpha_mean: float
    alpha_min: float
    deviation: float
    chord_use: float
    unit: str
    warnings: tuple[str, ...]
    missing: int
    """Faces that were not meshed, or lie off their surfaces."""
    seconds: dict[str, float]

    @property
    def clean(self) -> bool:
        """Whether every face was meshed, lies on its surface, and keeps to its chord."""
        return not self.missing and self.chord_use <= 1.0

    def __str__(self) -> str:
        used = f", {self.chord_use:.2f} of the chord" if self.chord_use else ""
        lines = [
            f"{self.path.name}: {self.nodes:,} nodes, {self.triangles:,} triangles in "
            f"{self.pieces} {'piece' if self.pieces == 1 else 'pieces'}",
            f"  area       {self.area:.10g} {self.unit}^2 (exact {self.area_of_model:.10g})",
            f"  shape      alpha mean {self.alpha_mean:.4f}, smallest {self.alpha_min:.4f}",
            f"  deviation  largest {self.deviation:.4g}{used}",
            "  not looked at: topology, self-intersection; 'surfmesh check' reads the whole mesh",
        ]
        return "\n".join(lines + [f"  note       {warning}" for warning in self.warnings])

    def to_dict(self) -> dict[str, Any]:
        """As JSON has it."""
        return {**vars(self), "path": str(self.path), "warnings": list(self.warnings)}


def mesh_into_pieces(
    path: str | Path, model: CadModel, sizing: Sizes, executor: Executor, *, optimise: bool = True,
    progress: Progress | None = None, strict: bool = True,
) -> PartitionedMesh:  # fmt: skip
    """Mesh a model into a .pvtu file in a folder that the workers of ``executor`` see too.

    sizing, executor, optimise, progress, strict: as of ``mesh``, but for ``order=2`` and
    ``triangles=``, which take the whole mesh. The pieces lie in a folder beside the file, one for
    the faces of a worker; the index is written last.

    Raises ``MeshingError`` and ``SizingError`` as ``mesh`` does, and where the workers do not see
    the folder; ``FileFormatError`` where it cannot be written. The old mesh is then as it was.
    """
    optimise, strict = truth_value("optimise", optimise), truth_value("strict", strict)
    require_executor(executor)
    path = Path(path)
    folder = pvtu.folder_of(path)
    for left in FaceStore.all_in(folder):  # by callers that were killed
        if is_left(left.mark):
            left.remove()
    store = FaceStore.made_in(folder)
    try:
        with held(store.mark):
            workers = FaceWorkers(executor=executor, store=store)
            apart = mesh_faces_apart(model, sizing, workers, optimise, progress, strict)
            whole = _numbered(model, apart)
            parts = pvtu.parts_of(whole.counts)
            orders = [whole.order(part) for part in parts]
            sums: list[PieceSums] = []

            def write(places: list[Path]) -> Content:
                if progress is not None:
                    progress("write", 0.95)
                found = _by_executor(executor, orders, places)
                sums.extend(own for own, _ in found)
                return found[0][1]

            field = {n: v for n, v in content_of(apart.rims).of_all.items() if n != METRIC}
            pvtu.save_pieces(path, whole.digest, len(parts), write, field)
    finally:
        store.remove()
        pvtu.forget_empty(folder)
    if progress is not None:
        progress("write", 1.0)
    triangles, area = sum(s.triangles for s in sums), sum(s.area for s in sums)
    return PartitionedMesh(
        path=path,
        pieces=len(parts),
        nodes=whole.points,
        triangles=triangles,
        area=area,
        area_of_model=model.area,
        alpha_mean=sum(s.alpha_sum for s in sums) / triangles,
        alpha_min=min(s.alpha_min for s in sums),
        deviation=max(s.deviation for s in sums),
        unit=model.unit,
        chord_use=max(s.chord_use for s in sums),
        warnings=apart.rims.warnings,
        missing=len(apart.rims.findings),
        seconds=dict(apart.rims.seconds),
    )


def _by_executor(
    executor: Executor, orders: list["_PieceOrder"], places: list[Path]
) -> list[tuple[PieceSums, Content]]:
    jobs = [executor.submit(_written, order, str(at)) for order, at in zip(orders, places)]
    try:
        with executor_faults("write the pieces"):
            return [job.result() for job in jobs]
    finally:
        for job in jobs:
            job.cancel()


class _FaceOrder(NamedTuple):
    """A face of a piece: what it is, and the numbers that its own rows begin with."""

    mesh: StoredFaceMesh
    number: int
    surface: Surface
    turned: bool
    solids: NDArray  # (2,)
    names: NDArray  # (slots,) numbers in the whole of the nodes on its boundary
    first_point: int
    first_corner: int
    first_triangle: int


class _PieceOrder(NamedTuple):
    """All that a worker needs to write a piece."""

    faces: list[_FaceOrder]
    numbers: NDArray  # (k,) of shared points, ascending
    points: NDArray  # (k, 3)
    sizes: NDArray  # (k,)
    largest_size: float  # where none is known
    stretched: bool
    groups: MeshGroups
    promises: NDArray | None


class _Numbered(NamedTuple):
    """The faces that have triangles, with the numbers of their rows in the whole."""

    apart: FacesApart
    faces: list[_FaceOrder]
    counts: NDArray  # (f,) triangles
    points: int
    diagonal: float
    digest: str

    def order(self, rows: NDArray) -> _PieceOrder:
        faces = [self.faces[row] for row in rows.tolist()]
        rims = self.apart.rims
        used = [face.names[face.mesh.slots[_on_boundary(face.mesh)]] for face in faces]
        numbers = np.unique(np.concatenate(used))
        numbers = numbers[numbers >= 0]
        assert rims.sizes is not None  # noqa: S101 for mypy: every mesh of a model has them
        return _PieceOrder(
            faces, numbers, rims.points[numbers], rims.sizes[numbers], self.diagonal,
            rims.metric_root_3d is not None, rims.groups, rims.promises,
        )  # fmt: skip


def _on_boundary(mesh: FaceMesh) -> NDArray[np.bool_]:
    """(n,) Points of triangles that lie on the boundary."""
    used = np.zeros(len(mesh.points), bool)
    used[mesh.triangles.ravel()] = True
    return used & (mesh.slots >= 0)


def _numbered(model: CadModel, apart: FacesApart) -> _Numbered:
    """As ``joined_mesh`` numbers them: shared points that are used, then face after face."""
    meshed = [state for state in apart.faces if len(state.mesh.triangles)]
    names = [_names(state) for state in meshed]
    shared = 1 + max(int(own.max()) for own in names)
    used = np.zeros(shared, bool)
    for state, own in zip(meshed, names):
        used[own[state.mesh.slots[_on_boundary(state.mesh)]]] = True
    rank = np.where(used, np.cumsum(used) - 1, -1)
    rims, point, corner, triangle = apart.rims, int(used.sum()), 0, 0
    assert rims.solid_ids is not None and rims.turned_faces is not None  # noqa: S101 for mypy
    solids = np.full((len(apart.faces), 2), -1, rims.solid_ids.dtype)
    solids[rims.face_ids] = rims.solid_ids
    faces, digest = [], hashlib.sha256(rims.points.tobytes() + rims.triangles.tobytes())
    for state, own in zip(meshed, names):
        mesh = state.mesh
        if not isinstance(mesh, StoredFaceMesh):
            raise MeshingError(f"{state.label}: its mesh was not kept by the workers")
        turned = bool(rims.turned_faces[state.number])
        faces.append(
            _FaceOrder(mesh, state.number, state.job.surface, turned, solids[state.number],
                       rank[own], point, corner, triangle)
        )  # fmt: skip
        digest.update(f"{Path(mesh.file).name} {state.number}".encode())
        point += mesh.all_inner
        corner += mesh.all_corners
        triangle += mesh.count
    counts = np.array([face.mesh.count for face in faces])
    return _Numbered(apart, faces, counts, point, model.diagonal, digest.hexdigest()[:16])


def _names(state: FaceState) -> NDArray[np.int64]:
    return np.concatenate([piece.numbers for loop in state.job.loops for piece in loop])


def _written(order: _PieceOrder, place: str) -> tuple[PieceSums, Content]:
    """Write a piece, by a worker; its sums, and its arrays without rows."""
    mesh, numbers, corners, cells = _joined(order)
    content = content_of(mesh)
    of_all = {n: v for n, v in content.of_all.items() if n != METRIC}
    if METRIC in content.of_all:
        of_all |= {METRIC: content.of_all[METRIC], pvtu.METRIC_IDS: corners}
    content = content._replace(
        of_points={**content.of_points, POINT_IDS: numbers},
        of_cells={**content.of_cells, CELL_IDS: cells},
        of_all=of_all,
    )
    pvtu.write_piece(content, Path(place))
    nothing = content._replace(
        points=content.points[:0],
        cells=content.cells[:0],
        of_points={name: values[:0] for name, values in content.of_points.items()},
        of_cells={name: values[:0] for name, values in content.of_cells.items()},
        of_all={},
    )
    return _sums(mesh, order), nothing


def _joined(order: _PieceOrder) -> tuple[SurfaceMesh, NDArray, NDArray, NDArray]:
    """A piece as a mesh, and the numbers of its points, corners and triangles in the whole."""
    numbers, points, sizes = [order.numbers], [order.points], [order.sizes]
    triangles, uv_points, uv_triangles, roots, corners, cells = ([] for _ in range(6))
    point, corner = len(order.numbers), 0
    for face in order.faces:
        mesh = face.mesh.whole()
        inside = mesh.slots < 0
        inner = int(inside.sum())
        own = np.empty(len(mesh.points), np.int64)
        own[~inside] = np.searchsorted(order.numbers, face.names[mesh.slots[~inside]])
        own[inside] = point + np.arange(inner)
        turn = [0, 2, 1] if face.turned else [0, 1, 2]
        numbers.append(face.first_point + np.arange(inner))
        points.append(mesh.points[inside])
        sizes.append(mesh.sizes[inside])
        triangles.append(own[mesh.triangles][:, turn])
        uv_points.append(mesh.uv_points)
        uv_triangles.append(corner + mesh.uv_triangles[:, turn].astype(np.int64))
        roots += [metric_roots(mesh)] if order.stretched else []
        corners.append(face.first_corner + np.arange(len(mesh.uv_points)))
        cells.append(face.first_triangle + np.arange(len(mesh.triangles)))
        point, corner = point + inner, corner + len(mesh.uv_points)
    counts = [face.mesh.count for face in order.faces]
    every = np.concatenate(sizes)
    made = SurfaceMesh(
        points=np.concatenate(points),
        triangles=np.concatenate(triangles),
        uv_points=np.concatenate(uv_points),
        uv_triangles=np.concatenate(uv_triangles),
        face_ids=np.repeat([face.number for face in order.faces], counts),
        solid_ids=np.repeat([face.solids for face in order.faces], counts, axis=0),
        sizes=np.where(np.isfinite(every), every, order.largest_size),
        metric_root_3d=np.concatenate(roots) if order.stretched else None,
        groups=order.groups,
        promises=order.promises,
    )
    whole = [np.concatenate(rows).astype(np.int64) for rows in (numbers, corners, cells)]
    return made, whole[0], whole[1], whole[2]


def _sums(mesh: SurfaceMesh, order: _PieceOrder) -> PieceSums:
    found = shapes(mesh)
    counts = [face.mesh.count for face in order.faces]
    on_surfaces = mesh.replaced(
        face_ids=np.repeat(np.arange(len(counts)), counts),
        surfaces=tuple(face.surface for face in order.faces),
        turned_faces=np.array([face.turned for face in order.faces]),
        groups=MeshGroups(),
        promises=None,
    )
    far = deviation(on_surfaces, found.area)
    assert far is not None  # noqa: S101 for mypy: it has its surfaces
    used = 0.0
    if order.promises is not None:
        rows = mesh.face_ids if len(order.promises) > 1 else np.zeros(len(mesh.triangles), int)
        chord = order.promises[rows, 0]
        used = float(np.nan_to_num(far.by_triangle / chord).max())
    return PieceSums(
        len(mesh.triangles), float(found.area.sum()), float(found.alpha.sum()),
        float(found.alpha.min()), far.largest, used,
    )  # fmt: skip
