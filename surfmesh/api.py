"""The verbs: ``load`` what is to be meshed, ``intersect`` several, ``mesh`` it, ``check`` the mesh.

What only one kind of surface needs is imported once it is there: the first mesh of a formula
waits for no CAD.
"""

from __future__ import annotations

import logging
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from surfmesh._core import return_free_memory
from surfmesh.cad.model.is_cad_model import is_cad_model
from surfmesh.errors import FileFormatError, SizingError, SurfaceError, printable, shown
from surfmesh.geometry.number_range import RANGE
from surfmesh.geometry.surface import Surface
from surfmesh.loading import is_domain, mesh_of_file, model_or_surface
from surfmesh.result.surface_mesh import SurfaceMesh
from surfmesh.sizing.options.given_sizes import (
    Sizes,
    idle_options,
    sizes_by_name,
    sizes_for,
    sizes_of_order,
)
from surfmesh.sizing.options.sizing import Sizing
from surfmesh.truth_value import truth_value

if TYPE_CHECKING:
    from concurrent.futures import Executor

    from surfmesh.cad.model.cad_model import CadModel
    from surfmesh.meshing.estimate.estimation import Estimate
    from surfmesh.meshing.explain.explanation import Explanation
    from surfmesh.meshing.progress import Progress
    from surfmesh.quality import Report

logger = logging.getLogger(__name__)


def mesh(
    surface: Surface | CadModel | Any,
    sizing: Sizes = None,
    *,
    optimise: bool = True,
    progress: Progress | None = None,
    strict: bool = True,
    simplify: bool = False,
    jobs: int | None = None,
    executor: Executor | None = None,
    order: int | None = None,
    **sizes: Any,
) -> SurfaceMesh:
    """Triangulate a surface, or a CAD model (or whatever CadQuery object makes one).

    surface: one of these, or the path of a file or a name of the gallery, for ``load``.

    sizing: what is wanted; a number is a uniform edge length; None takes the defaults of the
    surface's formula file, or sensible ones. Options of ``Sizing`` may be given by name instead:
    ``mesh(part, chord=0.1)``, ``mesh(part, triangles=50_000)``.

    optimise: False gives the raw packing with its boundary, as in the paper.

    progress: called with (stage, fraction done); when it returns False the work stops.

    strict: False leaves out faces of a CAD model that cannot be meshed, and lists them in the
    mesh's ``warnings``.

    simplify: True collapses tiny edges of a CAD model, those below ``min_size`` or a
    two-thousandth of the diagonal, and thins lines of a planar domain that are finer than the
    sizes; topology is kept.

    jobs: how many threads mesh, faces of a CAD model at once or within one; by default as many as
    this process may use processors. The mesh is the same with any number of them.

    executor: meshes the faces of a CAD model instead, in other processes or on other machines: any
    of ``concurrent.futures``, or ``dask.distributed.Client(...).get_executor()``. A formula and a
    planar domain are one face, which is meshed here all the same.

    order: 2 puts nodes amid the edges too, on the true curves and surfaces
    (``mesh.mid_points``); a ``chord`` that is given is then that of the curved triangles, of which
    far fewer are needed. Without one the triangles are those of order 1, as many. None:
    ``Sizing.order``, 1 by default.

    Stages and their seconds go to the log ``surfmesh`` at level INFO, the mesh's warnings at
    WARNING. Safe to call from several threads at once.

    Raises ``SizingError``, ``SurfaceError`` or ``MeshingError`` with the place and the reason,
    ``Cancelled`` when ``progress`` said so.
    """
    from surfmesh.meshing.progress import tell_end

    _require_threads(jobs)
    optimise, strict = truth_value("optimise", optimise), truth_value("strict", strict)
    simplify = truth_value("simplify", simplify)
    if progress is not None and not callable(progress):
        raise SizingError(f"progress is {shown(progress)}, no function of (stage, fraction done)")
    if executor is not None:
        from surfmesh.meshing.executors import require_executor

        require_executor(executor)
    model = model_or_surface(surface)
    asked, order = sizes_of_order(sizes_by_name(sizing, sizes, beside=_OF_MESH), order)
    wanted = sizes_for(model, asked)

    def made_with(own: Sizes) -> SurfaceMesh:
        return _mesh_once(model, own, optimise, progress, strict, simplify, jobs, executor)

    if isinstance(wanted, Sizing) and wanted.triangles is not None:
        from surfmesh.meshing.progress import OneProgress
        from surfmesh.meshing.triangle_count import mesh_with_count

        progress = progress and OneProgress(progress)
        made = mesh_with_count(
            wanted, _diagonal(model), lambda own: estimate(model, own).triangles, made_with
        )
    else:
        made = made_with(wanted)
    if order == 2:
        from surfmesh.meshing.finishing.second_order import of_second_order

        made = of_second_order(made)
    tell_end(progress)
    return_free_memory(len(made.triangles))
    return _logged(made.with_warnings(*idle_options(wanted, optimise)), model)


_OF_MESH = ("optimise", "progress", "strict", "simplify", "jobs", "executor")


def _require_threads(jobs: Any) -> None:
    if jobs is not None and (isinstance(jobs, bool) or not isinstance(jobs, int) or jobs < 1):
        raise SizingError(f"jobs is {shown(jobs)}: at least one thread; None takes all processors")


def _mesh_once(
    model: Surface | CadModel, sizing: Sizes, optimise: bool, progress: Progress | None,
    strict: bool, simplify: bool, jobs: int | None, executor: Executor | None,
) -> SurfaceMesh:  # fmt: skip
    """The mesh of first order for given sizes, by the driver of what is to be meshed."""
    from surfmesh.meshing.processors import allowed_threads, processors

    threads = processors() if jobs is None else jobs
    if is_cad_model(model):
        from surfmesh.meshing.faces.face_workers import FaceWorkers
        from surfmesh.meshing.model_mesh import mesh_model

        workers = FaceWorkers(threads, executor)
        return mesh_model(model, sizing, optimise, progress, strict, simplify, workers)
    if is_domain(model):
        from surfmesh.meshing.planar_mesh import mesh_planar

        with allowed_threads(threads):
            straight = Sizing.of(sizing).replaced(order=1)  # outlines are polygons
            return mesh_planar(model, straight, optimise, progress, simplify)
    if simplify:
        raise SurfaceError(
            f"simplify is for CAD models and planar domains; {printable(model.name)} has no edges "
            "or lines to simplify"
        )
    from surfmesh.meshing.parametric_mesh import mesh_parametric

    with allowed_threads(threads):
        return mesh_parametric(model, Sizing.of(sizing), optimise, progress)


def _with_sizes(model: Surface | CadModel, sizing: Sizes) -> Sizes:
    """What ``mesh`` works with; where a number of triangles is asked for, sizes that give it."""
    wanted = sizes_for(model, sizes_of_order(sizing, None)[0])
    if not isinstance(wanted, Sizing) or wanted.triangles is None:
        return wanted
    from surfmesh.meshing.triangle_count import sizing_for_count

    return sizing_for_count(wanted, _diagonal(model), lambda own: estimate(model, own).triangles)[0]


def _diagonal(model: Surface | CadModel) -> float:
    """Of the bounding box, of a surface by a grid of points."""
    if is_cad_model(model):
        return model.diagonal
    from surfmesh.geometry.boxes import diagonal
    from surfmesh.geometry.parameter_grid import parameter_grid

    points = model.evaluate(parameter_grid(model.domain, 33), 0)[0]
    return diagonal(points[np.isfinite(points).all(axis=1)])


def intersect(
    surfaces: Sequence[Surface | CadModel | Any],
    keep: str | Mapping[Any, Any] = "all",
    coincident: str = "refuse",
) -> CadModel:
    """Surfaces and CAD models that cut each other, as one model for ``mesh``.

    surfaces: two or more of formulas, of functions, CAD models or CadQuery objects, in any mix.
    Their common curves become edges that the faces on all sides share, each cut once: meshes join
    there by index. Points where three meet become vertices of all three.

    keep: what of them.

        "all"             everything: a complex of sheets, also with dangling parts
        "union", "difference" (the first without the others), "common"
                          of closed inputs, models or closed surfaces: closed solids
        {name: side}      of the inputs named, by ``name`` or number, the parts on one side;
                          "+other": outside of it, or where its normal points; "-other"; a list of
                          these, which must all hold; a point (3,): the part that is nearest;
                          "all" or "none". Inputs that are not named are kept whole.

    coincident: what becomes of patches that lie on each other, as of a box that stands on another:
    "refuse" raises ``SurfaceError`` with the place, "merge" makes them one patch of both inputs.

    Faces have the names that they had, or that of their surface; edges along common curves
    "one/other". Tags select the faces of an input ("wing"), and on one side of another
    ("wing+body"), so that sizes can be asked for by these names. A face that is on both sides,
    as a cut ends inside it, has neither.

    Curves lie within 1e-10 of the diagonal of both surfaces as a rule; the tolerance of the edge
    says how near. No branch is missed on formulas, splines, planes, cylinders, cones, spheres
    and tori, whose bends have bounds; of others ``model.healing`` says that they were sampled.

    Where an edge of one lies on another, it is their common curve as it is. Surfaces that touch
    along a curve share it, and nothing is cut off there; a touch in a point within both faces is
    said in ``model.healing``, and leaves them as they are.

    Raises ``SurfaceError`` with the place where surfaces come near each other with one tangent
    plane without these contacts, and for a ``keep`` that cannot be met.
    """
    from surfmesh.intersection.intersect import intersected

    return intersected(
        [model_or_surface(surface) for surface in surfaces], keep, coincident=coincident
    )


def estimate(
    surface: Surface | CadModel | Any, sizing: Sizes = None, **sizes: Any
) -> Estimate:  # fmt: skip
    """How many triangles ``mesh`` would make, and how much memory it would need.

    Sizes are given as to ``mesh``, by name too: ``estimate(part, chord=0.1)``.
    Size fields are made and measured, of models with many faces those of some faces: of alike ones
    one, of many that differ a sample, of those with few triangles none (``by_face`` is rougher
    there than the total). Of large meshes a few patches are made to learn from, of small ones all:
    up to 600 triangles, or some thousand where sizes are coarse for the curvature or faces thin.
    Raises what ``mesh`` raises for sizes that cannot be met, but for their limit.
    """
    model = model_or_surface(surface)
    sizing = _with_sizes(model, sizes_by_name(sizing, sizes))
    if is_cad_model(model):
        from surfmesh.meshing.model_mesh import estimate_model

        return estimate_model(model, sizing)
    if is_domain(model):
        from surfmesh.meshing.planar_mesh import estimate_planar

        return estimate_planar(model, Sizing.of(sizing))
    from surfmesh.meshing.parametric_mesh import estimate_parametric

    return estimate_parametric(model, Sizing.of(sizing))


def explain(
    surface: Surface | CadModel | Any,
    sizing: Sizes,
    point: Sequence[float],
) -> Explanation:
    """Which rule decides the size at a point (3,), with the numbers of all that apply there.

    The point is moved to the nearest one of the surface or model. ``print`` it. Raises what
    ``mesh`` raises for sizes that cannot be met, and ``SizingError`` for what is no point.
    """
    model = model_or_surface(surface)
    sizing = _with_sizes(model, sizing)
    if is_cad_model(model):
        from surfmesh.meshing.model_mesh import explain_size

        return explain_size(model, sizing, _place(point))
    from surfmesh.meshing.parametric_mesh import explain_parametric

    return explain_parametric(model, Sizing.of(sizing), _place(point))


def check(
    mesh: SurfaceMesh | str | Path, *, second_opinion: bool = False, prove: bool | None = None
) -> Report:  # fmt: skip
    """Look at everything that can be said of a mesh, or of the mesh in a file: topology,
    self-intersection, shape, sizes, deviation, each of them against the model where that is known.

    second_opinion=True asks trimesh and PyVista too for what they know of: topology, area,
    volume, shapes, beside ours in ``report.second_opinion``. Where they disagree by more than
    rounding the mesh is not clean.

    prove=True bounds how far mesh and surfaces are from each other at most, both ways, in
    ``report.proof``: see docs/proof.md. None: where ``Sizing(proof=True)`` was asked for, and a
    triangle that is not proved is a problem then.

    Raises ``ValueError`` when its indices are out of range, ``FileFormatError`` for a file that
    holds no mesh; everything else that is wrong is in ``report.problems``.
    """
    from surfmesh import quality

    if isinstance(mesh, (str, Path)):
        mesh = mesh_of_file(mesh)
    if not isinstance(mesh, SurfaceMesh):
        raise FileFormatError(f"a mesh or the path of one is needed, not {shown(mesh)}")
    return quality.check(mesh, second_opinion=second_opinion, prove=prove)


def _place(point: Sequence[float]) -> NDArray[np.float64]:
    """The point as an array (3,)."""
    try:
        place = np.array(point, float)
    except (TypeError, ValueError, OverflowError):
        place = np.empty(0)
    if place.shape != (3,) or not (np.abs(place) <= RANGE.square).all():  # false for nan
        raise SizingError(
            f"a point is three finite numbers of at most {RANGE.square:g}, not {shown(point)}"
        )
    return place


def show(
    thing: SurfaceMesh | Surface | CadModel | Any,
    sizing: Sizes = None,
    *,
    by: str | None = None,
    path: str | Path | None = None,
    **options: Any,
) -> None:
    """Open a window, or a widget in a notebook; with ``path`` write a PNG instead.

    A mesh is shown as ``mesh.show`` does. A surface, a CAD model or a CadQuery object is shown
    before it is meshed: its curvature, or, when ``sizing`` is given, the size field that follows
    from it, with the principal directions. by, options: as in ``surfmesh.view.plot``.

    Raises what ``mesh`` and ``surfmesh.view.plot`` raise; ``SurfmeshError`` without a display.
    """
    from surfmesh import view
    from surfmesh.view.legend import name_of

    if isinstance(thing, SurfaceMesh):
        shown: SurfaceMesh = thing
        drawn: dict[str, Any] = {"by": by or "alpha"}
    else:  # the raw packing carries the field to where it changes
        shown = mesh(thing, sizing, optimise=False, strict=False)
        flat = is_domain(thing)
        first = "curvature" if sizing is None and not flat else "size"
        name = getattr(thing, "name", "") or name_of(shown)
        what = "curvature" if first == "curvature" else "size field"
        drawn = {"by": by or first, "edges": False, "directions": not flat, "worst": 0}
        drawn["title"] = f"{name}: {what}, {len(shown.points):,} circles"
    if path is None:
        view.show(shown, **(drawn | options))
    else:
        view.plot(shown, path, **(drawn | options))


def _logged(made: SurfaceMesh, surface: Surface | CadModel) -> SurfaceMesh:
    """The mesh itself, after saying in the log what became of the surface."""
    seconds = sum(made.seconds.values())
    points, triangles = len(made.points), len(made.triangles)
    logger.info("%s: %d nodes, %d triangles, %.2f s", surface.name, points, triangles, seconds)
    for warning in made.warnings:
        logger.warning("%s: %s", surface.name, warning)
    return made
