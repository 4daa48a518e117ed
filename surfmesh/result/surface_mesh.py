"""The result: an immutable triangle mesh on one or more surfaces.

Connectivity is by index alone: where two sides or two faces meet they share vertex numbers,
while each triangle keeps the surface parameters of its corners on its own face.

    vertex numbers (triangles)              corner parameters (uv_triangles)

        2 --- 5 --- 2                           8 --- 5 --- 2        a tube cut open: the
        | \\   | \\   |       one seam,            | \\   | \\   |        seam has one row of
        0 --- 3 --- 0       two images in uv    6 --- 3 --- 0        vertices, two of (u, v)
"""

from collections.abc import Mapping
from dataclasses import dataclass, field, fields, replace
from functools import cached_property
from pathlib import Path
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np
from numpy.typing import ArrayLike, NDArray

from surfmesh.result.connectivity import Connectivity, connect
from surfmesh.result.findings import Finding, FindingKind
from surfmesh.result.mesh_groups import MeshGroups
from surfmesh.result.model_facts import ModelFacts
from surfmesh.result.quadratic_triangles import edge_rows, six_nodes

if TYPE_CHECKING:
    import meshio
    import pyvista
    import trimesh

    from surfmesh.io import Manifest
    from surfmesh.quality.report import Report
    from surfmesh.quality.verdict.worst import WorstTriangle

NOT_MESHED = FindingKind.NOT_MESHED.value
"""How the warning about a CAD face starts that is missing: such a mesh is not clean."""


class Corners(NamedTuple):
    """Parameters of the corners of all triangles, where some have changed."""

    uv_points: NDArray[np.float64]  # (k, 2)
    uv_triangles: NDArray[Any]  # (m, 3) rows of uv_points
    source: NDArray[Any]  # (k,) rows of the mesh's own uv_points that they stand for


@dataclass(frozen=True, eq=False, repr=False, kw_only=True)
class SurfaceMesh:
    """Triangles on surfaces. Arrays are read-only; lengths are in model units.

    Arrays of another type or layout are converted, the others are kept as they are and
    become read-only. Raises ``ValueError`` when shapes do not agree; what the numbers say is
    looked at by ``check`` alone, so that a broken mesh can be held and examined.
    """

    points: NDArray[np.float64]  # (n, 3) vertices
    triangles: NDArray[np.int32]  # (m, 3) vertex numbers, counter-clockwise along r_u x r_v
    uv_points: NDArray[np.float64] | None = None  # (k, 2) distinct corner parameters
    uv_triangles: NDArray[np.int32] | None = None  # (m, 3) rows of uv_points; None: triangles
    # (m,) surface of each triangle; None, when it is made: all 0
    face_ids: NDArray[np.int32] = None  # type: ignore[assignment]
    surfaces: tuple[Any, ...] = ()  # by face_ids; empty when read from a file
    sizes: NDArray[np.float64] | None = None  # (n,) wanted edge length at each vertex
    # (k, 6) for each of uv_points W = xx, xy, xz, yy, yz, zz, as |W d| is the step d in wanted
    # lengths; None where sizes do not depend on the direction, or are not known: W = Id / sizes
    inverse_sizes: NDArray[np.float64] | None = None
    sizing: Any = None  # the options it was made with, those of the whole model
    # (f, 3) what was promised of each face, options by name among it: chord, angle (degrees) and
    # min_size, nan where nothing is asked for. One row: of all. None: what ``sizing`` says
    promises: NDArray[np.float64] | None = None
    seconds: Mapping[str, float] = field(default_factory=dict)  # by stage
    warnings: tuple[str, ...] = ()  # what the user should know
    findings: tuple[Finding, ...] = ()  # those of the warnings that are about one face, as records
    one_sided: bool = False  # no orientation exists (Moebius, Klein): none is demanded
    facts: ModelFacts | None = None  # what is known of the model beforehand
    # of CAD models; None otherwise
    turned_faces: NDArray[np.bool_] | None = None  # (f,) triangles run against r_u x r_v there
    narrow_faces: NDArray[np.bool_] | None = None  # (f,) closed between sides within the chord
    solid_ids: NDArray[np.int32] | None = None  # (m, 2) solid behind and before it; -1: none
    edge_segments: NDArray[np.int32] | None = None  # (k, 2) edges of the mesh on CAD edges
    edge_ids: NDArray[np.int32] | None = None  # (k,) their CAD edges
    edge_shares: NDArray[np.float64] | None = None  # (k, 2) of its range, at a segment's ends
    edge_curves: tuple[Any, ...] = ()  # by edge_ids: what has ``curve`` and ``parameters(share)``
    vertex_ids: NDArray[np.int32] | None = None  # (c,) vertex at each CAD vertex; -1: none
    mid_points: NDArray[np.float64] | None = None  # (ne, 3) nodes amid ``edges``; None: order 1
    # names, colours, kinds, unit; None: those of the surfaces
    groups: MeshGroups = None  # type: ignore[assignment]

    def __post_init__(self) -> None:
        def settle(name: str, value: ArrayLike, dtype: type, shape: tuple[int, ...]) -> None:
            if dtype is np.int32:
                value = _within_int32(name, value)
            array: NDArray[Any] = np.ascontiguousarray(value, dtype)
            fits = array.ndim == len(shape) and all(
                wanted in (-1, found) for wanted, found in zip(shape, array.shape)
            )
            if not fits:
                raise ValueError(f"{name} has shape {array.shape}, expected {shape} (-1: any)")
            array.setflags(write=False)
            object.__setattr__(self, name, array)

        settle("points", self.points, np.float64, (-1, 3))
        settle("triangles", self.triangles, np.int32, (-1, 3))
        n, m = len(self.points), len(self.triangles)
        face_ids = np.zeros(m, np.int32) if self.face_ids is None else self.face_ids
        settle("face_ids", face_ids, np.int32, (m,))
        if self.uv_points is not None:
            settle("uv_points", self.uv_points, np.float64, (-1, 2))
            uv_triangles = self.triangles if self.uv_triangles is None else self.uv_triangles
            settle("uv_triangles", uv_triangles, np.int32, (m, 3))
        elif self.uv_triangles is not None:
            raise ValueError("uv_triangles given without uv_points")
        if self.sizes is not None:
            settle("sizes", self.sizes, np.float64, (n,))
        if self.inverse_sizes is not None:
            if self.uv_points is None:
                raise ValueError("inverse_sizes given without uv_points")
            settle("inverse_sizes", self.inverse_sizes, np.float64, (len(self.uv_points), 6))
        for name, dtype, shape in (
            ("turned_faces", np.bool_, (len(self.surfaces),)),
            ("narrow_faces", np.bool_, (len(self.surfaces),)),
            ("solid_ids", np.int32, (m, 2)),
            ("edge_segments", np.int32, (-1, 2)),
            ("edge_ids", np.int32, (-1,)),
            ("edge_shares", np.float64, (-1, 2)),
            ("vertex_ids", np.int32, (-1,)),
            ("promises", np.float64, (-1, 3)),
        ):
            if getattr(self, name) is not None:
                settle(name, getattr(self, name), dtype, shape)
        if self.mid_points is not None:
            settle("mid_points", self.mid_points, np.float64, (len(self.edges), 3))
        object.__setattr__(self, "surfaces", tuple(self.surfaces))
        object.__setattr__(self, "edge_curves", tuple(self.edge_curves))
        if self.groups is None:
            object.__setattr__(self, "groups", MeshGroups.of_surfaces(self.surfaces))
        object.__setattr__(self, "warnings", tuple(self.warnings))
        object.__setattr__(self, "findings", tuple(self.findings))
        object.__setattr__(self, "seconds", dict(self.seconds))

    @property
    def uv(self) -> NDArray[np.float64] | None:
        """(m, 3, 2) corner parameters of each triangle on its own face, expanded on demand."""
        return None if self.uv_points is None else self.uv_points[self.uv_triangles]

    @cached_property
    def connectivity(self) -> Connectivity:
        """Unique edges and the triangles they join."""
        return connect(self.triangles)

    @property
    def edges(self) -> NDArray[np.int32]:
        """(ne, 2) vertex numbers of the distinct edges, the smaller first."""
        return self.connectivity.edges

    @property
    def boundary_edges(self) -> NDArray[np.int32]:
        """(nb, 2) vertex numbers of the edges that bound one triangle only."""
        return self.connectivity.boundary

    @property
    def order(self) -> int:
        """2 when edges have nodes in their middle, else 1."""
        return 1 if self.mid_points is None else 2

    @property
    def nodes(self) -> NDArray[np.float64]:
        """(n, 3), or (n + ne, 3) for order 2: ``points`` and then ``mid_points``."""
        if self.mid_points is None:
            return self.points
        return np.vstack((self.points, self.mid_points))

    @property
    def elements(self) -> NDArray[np.int32]:
        """(m, 3) or, for order 2, (m, 6) rows of ``nodes``: the corners, then the middles of
        the edges 0-1, 1-2, 2-0 as in VTK, Gmsh and Abaqus.
        """
        if self.order == 1:
            return self.triangles
        return six_nodes(self.triangles, self.connectivity, len(self.points))

    def face_name(self, face: int) -> str:
        """Name of face number ``face``, or ``face 3`` when it has none."""
        return self.groups.face_label(face)

    def check(self) -> str | None:
        """The first broken invariant in words, or None: indices in range, all finite, no
        corner twice in a triangle, no triangle twice, every vertex used, faces known.

        Says nothing of shape or of the surface: that is ``surfmesh.check(mesh)``.
        """
        n, k = len(self.points), 0 if self.uv_points is None else len(self.uv_points)
        for name, indices, limit in (
            ("triangles", self.triangles, n),
            ("uv_triangles", self.uv_triangles, k),
        ):
            if (
                indices is not None
                and indices.size
                and not 0 <= indices.min() <= (indices.max()) < limit
            ):
                bad = int(np.flatnonzero(((indices < 0) | (indices >= limit)).any(axis=1))[0])
                return f"{name}[{bad}] = {indices[bad].tolist()} is outside 0..{limit - 1}"
        for name in ("points", "uv_points", "sizes", "mid_points"):
            array = getattr(self, name)
            if array is not None and not np.isfinite(array).all():
                bad = int(np.flatnonzero(~np.isfinite(array).reshape(len(array), -1).all(1))[0])
                return f"{name}[{bad}] = {array[bad].tolist()} is not finite"
        if self.sizes is not None and n and self.sizes.min() <= 0:
            bad = int(self.sizes.argmin())
            return f"sizes[{bad}] = {self.sizes[bad]} is not positive"
        a, b, c = self.triangles.T
        repeated = np.flatnonzero((a == b) | (b == c) | (c == a))
        if len(repeated):
            bad = int(repeated[0])
            return f"triangle {bad} = {self.triangles[bad].tolist()} repeats a corner"
        twin = _first_duplicate(self.triangles)
        if twin is not None:
            return f"triangles {twin[0]} and {twin[1]} have the same corners"
        used = np.zeros(n, bool)
        used[self.triangles.reshape(-1)] = True
        if not used.all():
            return f"vertex {int(np.flatnonzero(~used)[0])} belongs to no triangle"
        if self.surfaces and len(self.face_ids):
            low, high = int(self.face_ids.min()), int(self.face_ids.max())
            if low < 0 or high >= len(self.surfaces):
                return f"face_ids run from {low} to {high}, surfaces are {len(self.surfaces)}"
        return None

    def submesh(
        self, kept: ArrayLike, as_vertex: ArrayLike | None = None, corners: "Corners | None" = None
    ) -> "SurfaceMesh":
        """The triangles ``kept``, (m,) bool or rows, on the vertices that they use: every array
        by vertex, corner, edge or triangle is renumbered with them.

        as_vertex: (n,) the vertex that takes the place of each, by default itself; corners:
        parameters of the corners where these have changed. Segments of CAD edges are kept that
        are edges still, nodes amid edges go to the middle where an edge has other ends now.
        """
        rows = np.arange(len(self.triangles))[np.asarray(kept)]
        becomes = np.arange(len(self.points)) if as_vertex is None else np.asarray(as_vertex)
        triangles = becomes[self.triangles[rows]]
        used = np.zeros(len(self.points), bool)
        used[triangles] = True
        number = np.where(used, np.cumsum(used) - 1, -1)
        changes: dict[str, Any] = {
            "points": self.points[used],
            "triangles": number[triangles],
            "face_ids": self.face_ids[rows],
            "solid_ids": None if self.solid_ids is None else self.solid_ids[rows],
            "sizes": None if self.sizes is None else self.sizes[used],
            "mid_points": None,
        }
        changes |= self._corners_of(rows, corners)
        if self.vertex_ids is not None:
            there = self.vertex_ids >= 0
            changes["vertex_ids"] = np.where(there, number[becomes[self.vertex_ids]], -1)
        if self.edge_segments is not None or self.mid_points is not None:
            table = connect(changes["triangles"].astype(np.int32))
            changes |= self._edges_of(table, number[becomes], np.flatnonzero(used))
        return replace(self, **changes)

    def _corners_of(self, rows: NDArray, corners: "Corners | None") -> dict[str, Any]:
        """Parameters of the corners of triangles ``rows``, and what else is by corner."""
        if self.uv_points is None or self.uv_triangles is None:
            return {}
        if corners is None:
            corners = Corners(self.uv_points, self.uv_triangles, np.arange(len(self.uv_points)))
        used, place = np.unique(corners.uv_triangles[rows], return_inverse=True)
        w = self.inverse_sizes
        return {
            "uv_points": corners.uv_points[used],
            "uv_triangles": place.reshape(-1, 3),
            "inverse_sizes": None if w is None else w[corners.source[used]],
        }

    def _edges_of(
        self, table: Connectivity, number: NDArray[np.int64], used: NDArray[np.int64]
    ) -> dict[str, Any]:
        """Segments of CAD edges and nodes amid edges, for the edges of ``table``; number: (n,)
        of each vertex there or -1; used: the vertex of each number."""
        changes: dict[str, Any] = {}
        if self.edge_segments is not None:
            pairs = number[self.edge_segments]
            there = np.flatnonzero((pairs >= 0).all(axis=1) & (pairs[:, 0] != pairs[:, 1]))
            there = there[edge_rows(table, pairs[there]) >= 0]
            shares = self.edge_shares
            changes["edge_segments"] = pairs[there]
            changes["edge_ids"] = self.edge_ids[there]  # type: ignore[index]
            changes["edge_shares"] = None if shares is None else shares[there]
        if self.mid_points is not None:
            ends = used[table.edges]
            row = edge_rows(self.connectivity, ends)
            middles = self.points[ends].mean(axis=1)
            middles[row >= 0] = self.mid_points[row[row >= 0]]
            changes["mid_points"] = middles
        return changes

    def with_warnings(self, *more: str) -> "SurfaceMesh":
        """The same mesh with more to say about it; itself, when there is nothing."""
        return replace(self, warnings=(*self.warnings, *more)) if more else self

    def flipped(self) -> "SurfaceMesh":
        """The same mesh turned over: its triangles face the other side; twice gives it back.

        Points, edges and all other numbers stay. For closed surfaces that face their inside.
        """
        turned = self.turned_faces
        if self.surfaces:
            turned = np.ones(len(self.surfaces), bool) if turned is None else ~turned
            if self.solid_ids is None and not turned.any():
                turned = None
        order = [0, 2, 1]
        return replace(
            self,
            triangles=self.triangles[:, order],
            uv_triangles=None if self.uv_triangles is None else self.uv_triangles[:, order],
            turned_faces=turned,
            solid_ids=None if self.solid_ids is None else self.solid_ids[:, ::-1],
        )

    @cached_property
    def report(self) -> "Report":
        """The certificate: ``surfmesh.check(mesh)``, made when it is first asked for."""
        from surfmesh.quality.report import check

        return check(self)

    def worst(self, count: int = 20) -> "tuple[WorstTriangle, ...]":
        """The triangles of the smallest alpha, the worst first, with face and position."""
        from surfmesh.quality.verdict.worst import worst_triangles

        return worst_triangles(self, count)

    def save(self, path: str | Path, *, ascii: bool = False) -> Path:
        """Write to ``path``, format by extension; see ``surfmesh.io.save``."""
        from surfmesh.io import save

        return save(self, path, ascii=ascii)

    def manifest(self, *files: str | Path) -> "Manifest":
        """Versions, options and hashes of the mesh and of ``files`` it was written to, for
        another machine to compare; see ``surfmesh.io.Manifest``.
        """
        from surfmesh.io import Manifest

        return Manifest.of(self, files)

    def to_pyvista(self) -> "pyvista.PolyData":
        """As PyVista PolyData with ``size``, ``face_id`` and ``alpha``; nothing is merged."""
        from surfmesh.io.vtk_xml import to_pyvista

        return to_pyvista(self)

    def to_trimesh(self) -> "trimesh.Trimesh":
        """As a trimesh.Trimesh with ``size`` and ``face_id``; nothing is merged."""
        from surfmesh.io.to_trimesh import to_trimesh

        return to_trimesh(self)

    def to_meshio(self) -> "meshio.Mesh":
        """As a meshio.Mesh; ``ImportError`` that says what to install without meshio."""
        from surfmesh.io.to_meshio import to_meshio

        return to_meshio(self)

    def show(self, by: str = "alpha", **options: Any) -> None:
        """Open an interactive window, or a widget in a notebook; see ``surfmesh.view.show``."""
        from surfmesh.view import show

        show(self, by=by, **options)

    def plot(self, path: str | Path, by: str = "alpha", **options: Any) -> Path:
        """Write a PNG without a display; see ``surfmesh.view.plot``."""
        from surfmesh.view import plot

        return plot(self, path, by=by, **options)

    def __repr__(self) -> str:
        faces = len(self.surfaces) or len(np.unique(self.face_ids))
        return (
            f"SurfaceMesh({len(self.points)} points, {len(self.triangles)} triangles, "
            f"{faces} {'face' if faces == 1 else 'faces'})"
        )

    def _repr_html_(self) -> str:
        from surfmesh.view.summary_html import summary_html

        return summary_html(self)

    def __getstate__(self) -> dict[str, Any]:  # without the cached connectivity
        return {item.name: getattr(self, item.name) for item in fields(self)}

    def __setstate__(self, state: dict[str, Any]) -> None:
        for name, value in state.items():
            object.__setattr__(self, name, value)
        self.__post_init__()  # unpickled arrays are writeable again


def _within_int32(name: str, value: ArrayLike) -> NDArray[Any]:
    """As an array of numbers that 32 bits hold: a conversion would cut others in silence."""
    array = np.asarray(value)
    if array.size and array.dtype.kind in "iuf" and array.dtype != np.int32:
        low, high = array.min(), array.max()
        if not (-(2**31) <= low and high < 2**31):
            far = high if low >= -(2**31) else low
            raise ValueError(f"{name} holds {far}, which is no number of 32 bits")
    return array


def _first_duplicate(triangles: NDArray[np.int32]) -> tuple[int, int] | None:
    """Two triangles with the same three corners in any order, or None."""
    a, b, c = triangles.astype(np.int64).T
    low, high = np.minimum(np.minimum(a, b), c), np.maximum(np.maximum(a, b), c)
    middle = a + b + c - low - high
    stride = int(high.max(initial=0)) + 1
    if stride <= 1 << 21:  # the three numbers fit into one
        keys = ((low * stride + middle) * stride + high)[None]
        order = np.argsort(keys[0])
    else:
        keys = np.stack((low, middle, high))
        order = np.lexsort(keys)
    same = np.flatnonzero((keys[:, order[1:]] == keys[:, order[:-1]]).all(axis=0))
    if not len(same):
        return None
    first, second = sorted(int(order[same[0] + i]) for i in (0, 1))
    return first, second
