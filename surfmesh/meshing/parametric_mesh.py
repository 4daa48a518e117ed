"""One parametric surface, all stages: the spine of surfmesh.

    sides -> size field -> packing -> boundary -> optimisation -> space, joined sides glued
"""

import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from dataclasses import dataclass

import numpy as np

from surfmesh.errors import MeshingError
from surfmesh.geometry.sides import SideTopology, find_sides
from surfmesh.geometry.surface import Surface
from surfmesh.kernels.background import scalar_sizes_at
from surfmesh.meshing.boundary_loops import BoundaryLoops, boundary_loops
from surfmesh.meshing.boundary_recovery import DomainMesh, recovered
from surfmesh.meshing.optimise import Optimiser
from surfmesh.meshing.packing import packed
from surfmesh.sizing.size_field import SizeField, size_field
from surfmesh.sizing.sizing import Sizing
from surfmesh.surface_mesh import SurfaceMesh

Progress = Callable[[str, float], None]
"""Called with the name of the stage that starts and the share of the work done, 0 to 1."""

_STAGES = {"sizing": 0.0, "packing": 0.2, "boundary": 0.4, "optimisation": 0.5, "mapping": 0.9}


class Stopwatch:
    """Seconds per stage; tells the progress callback when a stage starts."""

    def __init__(self, progress: Progress | None) -> None:
        self.seconds: dict[str, float] = {}
        self._progress = progress

    @contextmanager
    def stage(self, name: str) -> Iterator[None]:
        if self._progress is not None:
            self._progress(name, _STAGES[name])
        start = time.perf_counter()
        try:
            yield
        finally:
            self.seconds[name] = (
                self.seconds.get(name, 0.0) + time.perf_counter() - start
            )


def mesh_parametric(
    surface: Surface, sizing: Sizing, optimise: bool = True, progress: Progress | None = None
) -> SurfaceMesh:
    """Mesh one surface over its (u, v) rectangle or inside its trimming loops.

    Raises ``SizingError``, ``SurfaceError`` or ``MeshingError`` with the place and the reason.
    """
    watch = Stopwatch(progress)
    with watch.stage("sizing"):
        sides = find_sides(surface)
        field = size_field(surface, sizing, sides)
    with watch.stage("packing"):
        width, height = field.scaling.extent
        packing = packed(
            field.background,
            (0.0, 0.0, width, height),
            (0.5 * width, 0.5 * height),
            field.expected_vertices(),
        )
    with watch.stage("boundary"):
        loops = boundary_loops(surface, sides, field)
        domain = recovered(packing.t, loops, field, surface)
        del packing
    if optimise:
        with watch.stage("optimisation"):
            same = domain.node[loops.identity]
            Optimiser(domain.t, domain.node, same, surface, field).run()
    with watch.stage("mapping"):
        glued = _glued(surface, loops, domain, field)
    return SurfaceMesh(
        points=glued.points,
        triangles=glued.triangles,
        uv_points=glued.uv_points,
        uv_triangles=glued.uv_triangles,
        surfaces=(surface,),
        sizes=glued.sizes,
        sizing=field.sizing,
        seconds=watch.seconds,
        one_sided=sides.one_sided,
    )


@dataclass(frozen=True)
class _Glued:
    points: np.ndarray
    triangles: np.ndarray
    uv_points: np.ndarray
    uv_triangles: np.ndarray
    sizes: np.ndarray


def _glued(
    surface: Surface, loops: BoundaryLoops, domain: DomainMesh, field: SizeField
) -> _Glued:
    """Map to space and join what is one point there.

    Triangles that a collapsed side turns into an edge are dropped. Raises ``MeshingError``
    when gluing leaves an edge with more than two triangles: the sizes are too coarse there.
    """
    t = domain.t
    vertices = int(t.count[0])
    live = t.region[: t.count[1]] == 0
    corners = t.tri[: 3 * t.count[1]].reshape(-1, 3)[live]
    uv = field.scaling.to_uv(t.xy[:vertices])
    uv[domain.node] = loops.uv  # to the last bit
    same = np.arange(vertices)
    same[domain.node] = domain.node[loops.identity]
    used = np.zeros(vertices, bool)
    used[same[corners.ravel()]] = True
    number = np.cumsum(used) - 1
    triangles = number[same[corners]].astype(np.int32)
    a, b, c = triangles.T
    solid = (a != b) & (b != c) & (c != a)
    (points,) = surface.evaluate(uv[used], 0)
    sizes = np.empty(int(used.sum()))
    scalar_sizes_at(field.background, np.ascontiguousarray(t.xy[:vertices][used]), sizes)
    return _Glued(points, triangles[solid], uv, corners[solid], sizes)
