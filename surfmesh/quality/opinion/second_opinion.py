"""A second opinion: the figures of the report beside those of trimesh and of PyVista.

The report's own exact tests come first; a figure on which one of the libraries disagrees by more
than rounding makes the mesh not clean. Where a library means something else by a word, or has no
word for it, the row says so and compares nothing.
"""

from collections.abc import Callable, Iterator
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from surfmesh.quality.figures.figures import Figures
from surfmesh.quality.figures.second_opinion import OpinionRow, SecondOpinion
from surfmesh.quality.measures.by_solid import SolidRow
from surfmesh.quality.measures.shape import shapes
from surfmesh.quality.measures.solids import around_solids, shares_faces
from surfmesh.quality.opinion.libraries_asked import Answers, ask_pyvista, ask_trimesh
from surfmesh.quality.opinion.rounding_bounds import Bounds, Placed, bounds, no_bounds, placed
from surfmesh.quality.opinion.shapes_compared import compare_shapes
from surfmesh.quality.opinion.witness import Witness
from surfmesh.result.surface_mesh import SurfaceMesh

FARTHEST = 200
"""Largest binary exponent of lengths: products of four of them are doubles, and those of
triangles a billion times smaller."""
FEWEST_DIGITS = 0.01
"""Of a volume: where rounding alone may be more, nothing is compared."""
INDICES_ALONE = ("euler", "components")  # what both are asked without lengths
BY_TRIMESH = (*INDICES_ALONE, "watertight", "winding")
BY_PYVISTA = (*INDICES_ALONE, "irregular", "nonmanifold")
OF_SOLIDS = ("closed", "euler", "area", "volume")


class Seen(NamedTuple):
    """What the libraries are given, and how far rounding goes there."""

    whole: Placed
    limits: Bounds
    enclosing: Placed  # what volumes are of: solids that share faces have these twice
    enclosing_limits: Bounds
    unmeasured: str  # why areas, volumes and shapes are not looked at, if they are not


def second_opinion(mesh: SurfaceMesh, report: Figures) -> SecondOpinion:
    """Ask trimesh and PyVista for what ``report`` says of ``mesh``. What they raise becomes a
    row without an answer.

    They are given the corners of the triangles, moved and scaled without rounding.
    """
    rows: list[OpinionRow] = []
    if len(mesh.triangles):
        seen = _seen(mesh)
        rows = [*_of_trimesh(mesh, report, seen), *_of_pyvista(mesh, report, seen)]
    agreeing = [row.agree for row in rows if row.agree is not None]
    return SecondOpinion(compared=len(agreeing), agreed=sum(agreeing), rows=tuple(rows))


def _seen(mesh: SurfaceMesh) -> Seen:
    whole, limits, unmeasured = _placed(mesh.points, mesh.triangles)
    enclosing, enclosing_limits = whole, limits
    if shares_faces(mesh) and not unmeasured:
        enclosing = whole._replace(triangles=around_solids(mesh).triangles)
        enclosing_limits = bounds(enclosing)
    return Seen(whole, limits, enclosing, enclosing_limits, unmeasured)


def _placed(
    points: NDArray[np.float64], triangles: NDArray[np.int32]
) -> tuple[Placed, Bounds, str]:
    """A mesh as it is looked at, and why nothing but its indices can be, if that is so."""
    as_it_is, unbounded = Placed(points, triangles, 0), no_bounds(len(triangles))
    if not np.isfinite(points).all():
        return as_it_is, unbounded, "not all points are finite"
    near = placed(points, triangles)
    if abs(near.exponent) > FARTHEST:
        reason = f"lengths near 2^{near.exponent}: their products are no doubles"
        return as_it_is, unbounded, reason
    return near, bounds(near), ""


def _asked(ask: Callable[..., Answers], seen: Seen, *names: str) -> Answers:
    """Answers about the whole mesh, and the volume of what encloses one."""
    if seen.unmeasured:
        return ask(seen.whole, names)
    if seen.enclosing is seen.whole:
        return ask(seen.whole, (*names, "volume"))
    return ask(seen.whole, names) | ask(seen.enclosing, ("volume",))


def _of_trimesh(mesh: SurfaceMesh, report: Figures, seen: Seen) -> Iterator[OpinionRow]:
    """Of the whole mesh, then of each solid."""
    more = () if seen.unmeasured else ("area", "closed")
    found = _asked(ask_trimesh, seen, *BY_TRIMESH, *more)
    library = Witness("trimesh", seen.whole.exponent, seen.unmeasured)
    watertight = report.closed and not report.nonmanifold_edges
    library.same("watertight", watertight, found["watertight"])
    library.same("winding consistent", report.oriented, found["winding"])
    library.same("Euler number", report.euler, found["euler"])
    library.same("components", report.components, found["components"])
    library.near("area", report.area, found.get("area"), seen.limits.area, 2)
    _volume(library, report.volume, found.get("volume"), seen.enclosing_limits.volume)
    yield from library.rows
    if report.by_solid and not seen.unmeasured:
        yield from _of_solids(mesh, report, seen, found)


def _volume(
    library: Witness,
    ours: float | None,
    theirs: Any,
    bound: float,
    of: str = "",
    reason: str = "",
) -> None:
    """A row, where something is enclosed and rounding leaves some digits."""
    if ours is None:
        reason = reason or "nothing is enclosed"
    elif isinstance(theirs, float) and not bound <= FEWEST_DIGITS * abs(theirs):
        reason = "rounding alone may be above a hundredth of it"
    library.near("volume", ours, theirs, bound, 3, of, reason)


def _of_solids(
    mesh: SurfaceMesh, report: Figures, seen: Seen, found: Answers
) -> Iterator[OpinionRow]:
    """Of each solid, its triangles facing outwards; found: of the whole mesh."""
    around = around_solids(mesh)
    if len(report.by_solid) == 1 and np.array_equal(around.triangles, mesh.triangles):
        yield from _of_solid(report.by_solid[0], found, seen.whole, seen.limits, "")
        return
    order = np.argsort(around.solid, kind="stable")
    ends = np.cumsum(np.bincount(around.solid, minlength=len(report.by_solid)))
    for row, own in zip(report.by_solid, np.split(order, ends[:-1])):
        if len(own):
            used, corners = np.unique(around.triangles[own], return_inverse=True)
            triangles = corners.reshape(-1, 3).astype(np.int32)
            near, limits, unmeasured = _placed(mesh.points[used], triangles)
            yield from _of_solid(row, ask_trimesh(near, OF_SOLIDS), near, limits, unmeasured)


def _of_solid(
    row: SolidRow, found: Answers, near: Placed, limits: Bounds, unmeasured: str
) -> list[OpinionRow]:
    library = Witness("trimesh", near.exponent, unmeasured)
    of = f"solid {row.solid}" + f" ({row.name})" * bool(row.name)
    library.same("closed", row.closed, found["closed"], of)
    library.same("Euler number", row.euler, found["euler"], of)
    library.near("area", row.area, found["area"], limits.area, 2, of)
    _volume(library, row.volume, found["volume"], limits.volume, of)
    return library.rows


def _of_pyvista(mesh: SurfaceMesh, report: Figures, seen: Seen) -> list[OpinionRow]:
    """Of the whole mesh, and the shapes of its triangles."""
    reason = _why_not_vtk(mesh)
    more = () if seen.unmeasured else ("qualities",)
    found = {} if reason else _asked(ask_pyvista, seen, *BY_PYVISTA, *more)
    library = Witness("pyvista", seen.whole.exponent, seen.unmeasured)
    irregular = report.boundary_edges + report.nonmanifold_edges
    for quantity, ours, name in (
        ("edges not of two triangles", irregular, "irregular"),
        ("non-manifold edges", report.nonmanifold_edges, "nonmanifold"),
        ("Euler number", report.euler, "euler"),
        ("components", report.components, "components"),
    ):
        library.same(quantity, ours, found.get(name), "", reason)
    qualities = found.get("qualities")
    area = float(qualities["area"].sum()) if isinstance(qualities, dict) else qualities
    library.near("area", report.area, area, seen.limits.area, 2, "", reason)
    volume = None if report.volume is None else abs(report.volume)  # VTK's have no sign
    limits = seen.enclosing_limits
    _volume(library, volume, found.get("volume"), limits.volume + limits.heron, "", reason)
    compare_shapes(library, report, shapes(mesh), qualities, seen.limits.cosine, reason)
    return library.rows


def _why_not_vtk(mesh: SurfaceMesh) -> str:
    """What VTK would count otherwise, or must not be given."""
    if not np.isfinite(mesh.points).all():
        return "not all points are finite"
    a, b, c = mesh.triangles.T
    repeated = ((a == b) | (b == c) | (c == a)).any()
    return "a triangle repeats a corner: no edge to VTK" if repeated else ""
