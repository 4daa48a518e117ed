"""The result: an immutable triangle mesh on one or more surfaces.

Connectivity is by index alone: where two sides or two faces meet they share vertex numbers,
while each triangle keeps the surface parameters of its corners on its own face.

    vertex numbers (triangles)              corner parameters (uv_triangles)

        2 --- 5 --- 2                           8 --- 5 --- 2        a tube cut open: the
        | \\   | \\   |       one seam,            | \\   | \\   |        seam has one row of
        0 --- 3 --- 0       two images in uv    6 --- 3 --- 0        vertices, two of (u, v)
"""

from __future__ import annotations

from dataclasses import dataclass, field, fields
from functools import cached_property
from pathlib import Path
from typing import TYPE_CHECKING, Any, Unpack

import numpy as np
from numpy.typing import ArrayLike, NDArray

from surfmesh.renamed import Renamed, new_names
from surfmesh.result.connectivity import Connectivity, connect
from surfmesh.result.invariants import first_broken
from surfmesh.result.mesh_fields import MeshFields
from surfmesh.result.mesh_part import (
    EDGE,
    TRIANGLE,
    VERTEX,
    FloatArray,
    Int32Array,
    MeshPart,
    Renumbering,
    array_fields,
    fit,
    renumbered_arrays,
    rows,
)
from surfmesh.result.mesh_parts import EdgeLinks, ModelLinks, Parametrisation, Record
from surfmesh.result.part_attributes import PartAttributes
from surfmesh.result.quadratic_triangles import edge_rows, node_values, six_nodes

if TYPE_CHECKING:
    from collections.abc import Mapping
    from types import ModuleType

    import meshio
    import pyvista
    import trimesh

    from surfmesh.io import Manifest
    from surfmesh.quality.report import Report
    from surfmesh.quality.verdict.worst import WorstTriangle
    from surfmesh.volume import VolumeMesh


@dataclass(frozen=True, eq=False, repr=False, init=False, kw_only=True)
class SurfaceMesh(PartAttributes):
    """Triangles on surfaces. Arrays are read-only; lengths are in model units.

    points: (n, 3) vertices.
    triangles: (m, 3) vertex numbers, counter-clockwise along r_u x r_v.
    sizes: (n,) target edge length at each vertex, or None.
    mid_points: (ne, 3) nodes amid ``edges``; None: order 1.
    one_sided: no orientation exists (Moebius, Klein): none is demanded.
    parametrisation, model_links, edge_links, record: the parts, whose fields are attributes too.

    ``SurfaceMesh(points=..., triangles=..., uv_points=..., face_ids=..., ...)`` takes the fields
    of all parts by their names, which are attributes of the mesh too, and whole parts.

    Arrays of another type or layout are converted, the others are kept as they are and
    become read-only. Raises ``ValueError`` when shapes do not agree; what the numbers say is
    looked at by ``check`` alone, so that a broken mesh can be held and examined.
    """

    points: FloatArray = field(metadata=rows(np.float64, VERTEX, 3))
    triangles: Int32Array = field(metadata=rows(np.int32, TRIANGLE, 3, holds=VERTEX))
    sizes: FloatArray | None = field(default=None, metadata=rows(np.float64, VERTEX))
    mid_points: FloatArray | None = field(default=None, metadata=rows(np.float64, EDGE, 3))
    one_sided: bool = False
    parametrisation: Parametrisation | None = None
    model_links: ModelLinks
    edge_links: EdgeLinks | None = None
    record: Record

    inverse_sizes, edge_shares = Renamed("metric_root_3d"), Renamed("edge_parameters")

    def __init__(
        self, *, points: ArrayLike, triangles: ArrayLike, **given: Unpack[MeshFields]
    ) -> None:
        found = new_names(type(self), given)
        own = {name: found.pop(name, None) for name in ("sizes", "mid_points")}
        own |= {"points": points, "triangles": triangles}
        own |= {"one_sided": found.pop("one_sided", False)}
        for name, value in own.items():
            object.__setattr__(self, name, value)
        counts = fit(self, {})
        if self.mid_points is not None:
            fit(self, counts | {EDGE: len(self.edges)})
        for name, kind in _PARTS.items():
            part = self._part_of(kind, found.pop(name, None), found)
            if part is not None:
                fit(part, counts)
            object.__setattr__(self, name, part)
        if found:
            raise TypeError(f"a SurfaceMesh has no {', '.join(found)}")

    def _part_of(
        self, kind: type[MeshPart], known: MeshPart | None, found: dict[str, Any]
    ) -> MeshPart | None:
        """The part ``known`` with the fields of it that are taken out of ``found``."""
        names = [item.name for item in fields(kind)]
        if known is not None and not any(name in found for name in names):
            return known
        held = {} if known is None else {name: getattr(known, name) for name in names}
        held |= {name: found.pop(name) for name in names if name in found}
        if kind is ModelLinks and held.get("face_ids") is None:
            held["face_ids"] = np.zeros(len(self.triangles), np.int32)
        if kind in (Parametrisation, EdgeLinks):
            if all(
                value is None or (isinstance(value, tuple) and not value) for value in held.values()
            ):
                return None
            if held.get("uv_points") is not None and held.get("uv_triangles") is None:
                held["uv_triangles"] = self.triangles
            held = dict.fromkeys(name for name, _ in array_fields(kind)) | held
        return kind(**held)

    def replaced(
        self,
        *,
        points: ArrayLike | None = None,
        triangles: ArrayLike | None = None,
        **changes: Unpack[MeshFields],
    ) -> SurfaceMesh:
        """A copy with some fields changed."""
        found: dict[str, Any] = {item.name: getattr(self, item.name) for item in fields(self)}
        found |= changes
        found |= {"points": points} if points is not None else {}
        found |= {"triangles": triangles} if triangles is not None else {}
        return SurfaceMesh(**found)

    @property
    def uv(self) -> NDArray[np.float64] | None:
        """(m, 3, 2) corner parameters of each triangle on its own face, expanded on demand."""
        corners = self.parametrisation
        return None if corners is None else corners.uv_points[corners.uv_triangles]

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

    @property
    def node_sizes(self) -> FloatArray | None:
        """Target sizes at ``nodes``: halfway between the ends in the middle of an edge."""
        return (
            self.sizes
            if self.sizes is None or self.order == 1
            else node_values(self.sizes, self.edges)
        )

    @property
    def edge_elements(self) -> NDArray[np.integer[Any]]:
        """(k, 2) or, for order 2, (k, 3) rows of ``nodes`` of the segments on CAD edges."""
        if self.edge_segments is None:
            return np.empty((0, 1 + self.order), np.int32)
        if self.order == 1:
            return self.edge_segments
        middles = len(self.points) + self.edge_segment_rows
        return np.column_stack((self.edge_segments, middles))

    @cached_property
    def edge_segment_rows(self) -> NDArray[np.int64]:
        """(k,) rows of ``edges`` of the segments on CAD edges; -1: no edge of a triangle."""
        if self.edge_segments is None:
            return np.empty(0, np.int64)
        return edge_rows(self.connectivity, self.edge_segments)

    def face_name(self, face: int) -> str:
        """Name of face number ``face``, or ``face 3`` when it has none."""
        return self.groups.face_label(face)

    def broken_invariant(self) -> str | None:
        """The first broken invariant in words, or None: indices in range, all finite, no
        corner twice in a triangle, no triangle twice, every vertex used, faces known.

        Says nothing of shape or of the surface: that is ``check``.
        """
        return first_broken(
            self.points, self.triangles, self.sizes, self.mid_points, self.parametrisation,
            self.model_links,
        )  # fmt: skip

    def submesh(
        self,
        kept: ArrayLike,
        as_vertex: ArrayLike | None = None,
        parametrisation: Parametrisation | None = None,
    ) -> SurfaceMesh:
        """The triangles ``kept``, (m,) bool or rows, on the vertices that they use: every array
        by vertex, corner, edge or triangle is renumbered with them.

        as_vertex: (n,) the vertex that takes the place of each, by default itself;
        parametrisation: of all triangles, where it has changed. Segments of CAD edges are kept
        that are edges still, nodes amid edges go to the middle where an edge has other ends now.
        """
        n, left = len(self.points), np.arange(len(self.triangles))[np.asarray(kept)]
        becomes = np.arange(n) if as_vertex is None else np.asarray(as_vertex)
        vertices = Renumbering.keeping(np.unique(becomes[self.triangles[left]]), n, becomes)
        kinds = {TRIANGLE: Renumbering(left), VERTEX: vertices}
        corners = parametrisation or self.parametrisation
        part = self.replaced(
            **renumbered_arrays(self, kinds) | {"mid_points": None, "edge_links": None},
            parametrisation=None if corners is None else corners.of_triangles(left),
            model_links=self.model_links.renumbered(kinds),
        )
        changes: MeshFields = {}
        if self.edge_links is not None:
            changes["edge_links"] = self.edge_links.on_edges(part.connectivity, vertices)
        if self.mid_points is not None:
            changes["mid_points"] = self._middles_of(vertices.rows[part.edges])
        return part.replaced(**changes) if changes else part

    def _middles_of(self, ends: Int32Array) -> FloatArray:
        """(k, 3) the nodes amid the edges between vertices ``ends`` (k, 2), where they are edges;
        halfway between them where they are not."""
        row = edge_rows(self.connectivity, ends)
        middles = self.points[ends].mean(axis=1)
        if self.mid_points is not None:
            middles[row >= 0] = self.mid_points[row[row >= 0]]
        return middles

    def with_warnings(self, *more: str) -> SurfaceMesh:
        """The same mesh with more to say about it; itself, when there is nothing."""
        return self.replaced(warnings=(*self.warnings, *more)) if more else self

    def flipped(self) -> SurfaceMesh:
        """The same mesh turned over: its triangles face the other side; twice gives it back.

        Points, edges and all other numbers stay. For closed surfaces that face their inside.
        """
        order, uv = [0, 2, 1], self.uv_triangles
        return self.replaced(
            triangles=self.triangles[:, order],
            uv_triangles=None if uv is None else uv[:, order],
            model_links=self.model_links.flipped(),
        )

    def check(self, *, second_opinion: bool = False, prove: bool | None = None) -> Report:
        """The certificate: shape, sizes, topology, the distance from the surfaces; see
        ``surfmesh.check``."""
        from surfmesh.quality.report import check

        return check(self, second_opinion=second_opinion, prove=prove)

    @cached_property
    def report(self) -> Report:
        """``mesh.check()``, made when it is first asked for."""
        return self.check()

    def worst(self, count: int = 20) -> tuple[WorstTriangle, ...]:
        """The triangles of the smallest alpha, the worst first, with face and position."""
        from surfmesh.quality.verdict.worst import worst_triangles

        return worst_triangles(self, count)

    def save(
        self, path: str | Path, *, ascii: bool = False, solids: str = "", target: str = ""
    ) -> Path:  # fmt: skip
        """Write to ``path``, format by extension; see ``surfmesh.io.save``."""
        from surfmesh.io import save

        return save(self, path, ascii=ascii, solids=solids, target=target)

    def manifest(self, *files: str | Path) -> Manifest:
        """Versions, options and hashes of the mesh and of ``files`` it was written to, for
        another machine to compare; see ``surfmesh.io.Manifest``.
        """
        from surfmesh.io import Manifest

        return Manifest.of(self, files)

    def to_pyvista(self) -> pyvista.PolyData:
        """As PyVista PolyData with ``size``, ``face_id`` and ``alpha``; nothing is merged."""
        from surfmesh.io.vtk_xml import to_pyvista

        return to_pyvista(self)

    def to_trimesh(self) -> trimesh.Trimesh:
        """As a trimesh.Trimesh with ``size`` and ``face_id``; nothing is merged."""
        from surfmesh.io.to_trimesh import to_trimesh

        return to_trimesh(self)

    def to_meshio(self) -> meshio.Mesh:
        """As a meshio.Mesh; ``MissingExtraError`` without meshio."""
        from surfmesh.io.to_meshio import to_meshio

        return to_meshio(self)

    def show(self, by: str = "alpha", **options: Any) -> None:
        """Open an interactive window, or a widget in a notebook; see ``surfmesh.view.show``."""
        from surfmesh.view import show

        show(self, by=by, **options)

    def to_gmsh(self, name: str = "surfmesh") -> ModuleType:
        """Add a model to Gmsh that ``gmsh.model.mesh.generate(3)`` fills; returns ``gmsh``.

        See ``surfmesh.volume.gmsh_model.to_gmsh``.
        """
        from surfmesh.volume.gmsh_model import to_gmsh

        return to_gmsh(self, name)

    def save_dagmc(self, path: str | Path, materials: str | Mapping[str, str]) -> Path:
        """Write a .h5m for DAGMC with the materials of solids; see ``surfmesh.io.dagmc``."""
        from surfmesh.io.dagmc import save_dagmc

        return save_dagmc(self, path, materials)

    def tetrahedralize(
        self, engine: str = "tetgen", *, size: float | None = None, order: int | None = None
    ) -> VolumeMesh:  # fmt: skip
        """Tetrahedra inside the solids; see ``surfmesh.volume.tetrahedralize``."""
        from surfmesh.volume import tetrahedralize

        return tetrahedralize(self, engine, size=size, order=order)

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
        SurfaceMesh.__init__(self, **state)  # unpickled arrays are writeable again


_PARTS: dict[str, type[MeshPart]] = {
    "parametrisation": Parametrisation,
    "model_links": ModelLinks,
    "edge_links": EdgeLinks,
    "record": Record,
}
