"""One surface or CAD model by one mesher, within measured deviations, in a process of its own.

truth    no mesh to show: what the others need, written to a folder of the caller's
ours     surfmesh with the chord asked for, at each ratio: nothing is searched
searched surfmesh as the peers: the largest chord, asked for, that keeps the limit, isotropic
gmsh     Frontal-Delaunay; the fewest elements a circle that keep the limit
netgen   surface meshing; the smallest ``curvaturesafety`` that keeps it
ocp      OpenCASCADE's tessellation; the largest linear deflection that keeps it

A limit is kept when 99.9 % of the triangles lie within, as ``true_distance`` sees it. Peers read
the B-rep as OpenCASCADE reads it from the file, unhealed, in millimetres; their largest size is
ours, a tenth of the diagonal (OpenCASCADE's tessellation knows none).
"""

import single_thread  # noqa: F401  (before numpy)

# isort: split
import math
import pickle
from collections.abc import Callable
from pathlib import Path
from time import perf_counter
from typing import NamedTuple

import child_process
import numpy as np
from cad_measures import own_vertices, shape_figures, without_collapsed
from fewest import next_fineness, reach
from true_distance import TrueSurface, by_triangle, true_surface

from surfmesh.quality.measures.shape import shapes

FORMULA, SHAPE = "formula:", "shape:"  # how a place starts that is no file
TRUTH, BREP = "truth.pickle", "model.brep"
SLACK = 1.0 + 1e-9  # of a limit, for rounding
ATTEMPTS = 9
TYPICAL_RADIUS = 0.05  # of the diagonal, for the first attempt
DEAREST = 1.5  # an attempt may cost this much more than the one before foretells
Mesh = tuple[np.ndarray, np.ndarray, int]  # points (n, 3), triangles (m, 3), faces without any


def run(mesher: str, place: str, timeout: float, **asked: object) -> dict:
    """place: "formula:NAME", "shape:NAME" or a file. "rows", and "error" when it ended early."""
    request = {"mesher": mesher, "place": place, "time_limit": timeout, **asked}
    return child_process.run("sizing_meshers.py", request, timeout)


def _truth(request: dict) -> dict:
    from cad_ocp import shape_of
    from OCP.BRepTools import BRepTools

    model = _model(request["place"])
    folder, name = Path(request["folder"]), request["place"]
    shape = _shape(name).wrapped if name.startswith(SHAPE) else shape_of(Path(name))
    BRepTools.Clean_s(shape)
    BRepTools.Write_s(shape, str(folder / BREP))
    (folder / TRUTH).write_bytes(pickle.dumps(true_surface(model)))
    return {"diagonal": model.diagonal, "faces": len(model.faces), "area": model.area}


def _shape(place: str):
    from sizing_shapes import SHAPES

    return SHAPES[place.removeprefix(SHAPE)]()


def _model(place: str):
    import surfmesh as sm

    return sm.from_cadquery(_shape(place)) if place.startswith(SHAPE) else sm.load(place)


def _formula(place: str):
    from sizing_shapes import FORMULAS

    import surfmesh as sm

    name = place.removeprefix(FORMULA)
    if name not in FORMULAS:
        return sm.load(name)
    x, y, z, u, v = FORMULAS[name]
    return sm.ParametricSurface(x, y, z, u, v, name=name)


def _ours(request: dict) -> dict:
    from target_count import diagonal

    formula = request["place"].startswith(FORMULA)
    subject = _formula(request["place"]) if formula else _model(request["place"])
    truth = None if formula else _read_truth(request)
    size = diagonal(subject) if formula else subject.diagonal
    rows = []
    for share in request["deviations"]:
        for ratio in request["ratios"]:
            row = _ours_once(subject, size / share, ratio, truth, request["most"])
            rows.append({"share": share, "ratio": ratio, **row})
            child_process.say({"rows": rows})
    return {"rows": rows}


def _ours_once(subject, chord: float, ratio: float, truth: TrueSurface | None, most: int) -> dict:
    import surfmesh as sm
    from surfmesh.errors import SurfmeshError
    from surfmesh.quality.measures.deviation import deviation

    sizing = sm.Sizing(chord=chord, anisotropy=ratio)
    try:
        known = {"predicted": _predicted(subject, sizing)}
        if (known["predicted"] or 0) > most:
            return {**known, "left_out": f"more than {most:,}"}
        start = perf_counter()
        mesh = sm.mesh(subject, sizing) if truth is None else sm.mesh(subject, sizing, strict=False)
        seconds = perf_counter() - start
    except SurfmeshError as error:
        return {"left_out": f"{type(error).__name__}: {error}"[:300]}
    report = sm.check(mesh)
    away = deviation(mesh, shapes(mesh).area).by_triangle / chord
    faces = 1 if truth is None else len(subject.faces)
    farthest = np.full(faces, np.inf)  # what has no mesh keeps no promise
    farthest[np.unique(mesh.face_ids)] = 0.0
    np.maximum.at(farthest, mesh.face_ids, away)
    stretched = report.alpha_metric_mean is not None
    if truth is not None:
        known |= _judged(truth, mesh.points, mesh.triangles, chord)
    return {
        **known,
        "triangles": report.triangles,
        "faces": faces,
        "faces_kept": int(np.count_nonzero(farthest <= SLACK)),
        "missing": int(np.count_nonzero(np.isinf(farthest))),
        "largest": float(away.max()),
        "median": float(np.median(away)),
        "below_half": float((away < 0.5).mean()),
        "alpha_mean": report.alpha_metric_mean if stretched else report.alpha_mean,
        "alpha_min": report.alpha_metric_min if stretched else report.alpha_min,
        "quasi_unit": report.quasi_unit_share,
        "folded": report.folded,
        "area": report.area,
        "seconds": seconds,
    }


def _predicted(subject, sizing) -> int | None:
    """Triangles that are foretold; None when nothing foretells them."""
    import surfmesh as sm

    if hasattr(sm, "estimate"):
        found = sm.estimate(subject, sizing)
        return int(getattr(found, "triangles", found))
    if not hasattr(subject, "domain"):
        return None
    from surfmesh.geometry.differential.sides import find_sides
    from surfmesh.sizing.field.size_field import size_field

    return int(2 * size_field(subject, sizing, find_sides(subject)).expected_vertices())


def _read_truth(request: dict) -> TrueSurface:
    return pickle.loads(Path(request["folder"], TRUTH).read_bytes())


def _judged(truth: TrueSurface, points: np.ndarray, triangles: np.ndarray, limit: float) -> dict:
    away = by_triangle(truth, points, triangles, limit) / limit
    return {
        "reach": reach(away),
        "seen_largest": float(away.max()),
        "within": float((away <= SLACK).mean()),
    }


def _ours_searched(request: dict) -> dict:
    import surfmesh as sm

    model = _model(request["place"])

    def mesh(fineness: float, limit: float) -> Mesh:
        made = sm.mesh(model, sm.Sizing(chord=limit / fineness**2), strict=False)
        bare = len(model.faces) - len(np.unique(made.face_ids))
        return made.points, made.triangles, bare

    return _searched(request, mesh, lambda around: 1.0, 0.3, 3.0)


def _gmsh(request: dict) -> dict:
    import cad_gmsh

    cad_gmsh.read(str(Path(request["folder"], BREP)), request["max_size"])

    def mesh(circle: float, limit: float) -> Mesh:
        figures, (points, of_face) = cad_gmsh.attempt(circle, [])
        return points, np.concatenate([np.empty((0, 3), int), *of_face.values()]), figures["failed"]

    return _searched(request, mesh, lambda around: around, 3.0, 2000.0)


def _netgen(request: dict) -> dict:
    from netgen.meshing import MeshingStep
    from netgen.occ import OCCGeometry

    geometry = OCCGeometry(str(Path(request["folder"], BREP)))
    faces = len(geometry.shape.faces)

    def mesh(safety: float, limit: float) -> Mesh:
        made = geometry.GenerateMesh(
            maxh=request["max_size"], curvaturesafety=safety, perfstepsend=MeshingStep.MESHSURFACE
        )
        elements = made.Elements2D().NumPy()
        bare = faces - len(np.unique(elements["index"]))
        # copies: both are views of what netgen frees with the mesh
        return np.array(made.Coordinates()), elements["nodes"][:, :3].astype(int) - 1, bare

    # a size is radius / curvaturesafety
    return _searched(request, mesh, lambda around: around / (2.0 * math.pi), 0.1, 300.0)


def _ocp(request: dict) -> dict:
    from cad_ocp import faces_of, shape_of, triangles_of
    from OCP.BRepMesh import BRepMesh_IncrementalMesh
    from OCP.BRepTools import BRepTools

    shape = shape_of(Path(request["folder"], BREP))

    def mesh(fineness: float, limit: float) -> Mesh:
        BRepTools.Clean_s(shape)  # or a finer mesh is taken again
        BRepMesh_IncrementalMesh(shape, limit / fineness**2, False, math.pi / 2.0, False)
        faces = [triangles_of(face) for face in faces_of(shape)]
        points = np.concatenate([np.empty((0, 3, 3)), *faces]).reshape(-1, 3)
        return points, np.arange(len(points)).reshape(-1, 3), sum(not len(f) for f in faces)

    return _searched(request, mesh, lambda around: 1.0, 0.1, 20.0)


class Search(NamedTuple):
    """What one deviation asks of a mesher."""

    mesh: Callable[[float, float], Mesh]  # of a fineness, see ``fewest``, and the limit
    bounds: tuple[float, float]  # of the fineness
    limit: float  # model units
    most: int  # triangles
    until: float  # on the clock
    say: Callable[[dict], None]  # is told of each attempt, lest a later one hangs


def _searched(
    request: dict,
    mesh: Callable[[float, float], Mesh],
    first: Callable[[float], float],
    lowest: float,
    highest: float,
) -> dict:
    """The fewest triangles for each deviation. ``first`` turns the elements that a typical
    circle needs into a fineness."""
    truth, rows = _read_truth(request), []
    began, deviations = perf_counter(), request["deviations"]
    for number, share in enumerate(deviations):

        def say(row: dict, before: tuple = tuple(rows), share: float = share) -> None:
            child_process.say({"rows": [*before, {"share": share, **row}]})

        # an equilateral triangle of side h lies h^2 / 6 r inside a sphere of radius r
        start = first(2.0 * math.pi * math.sqrt(TYPICAL_RADIUS * share / 6.0))
        now = perf_counter()
        until = now + (0.95 * request["time_limit"] - (now - began)) / (len(deviations) - number)
        limit = request["diagonal"] / share
        search = Search(mesh, (lowest, highest), limit, request["most"], until, say)
        rows.append({"share": share, **_fewest(search, start, truth)})
    return {"rows": rows}


def _fewest(search: Search, fineness: float, truth: TrueSurface) -> dict:
    """The best attempt, all that were "tried" and why the search was "cut_short", if it was."""
    tried, best, why = [], {}, ""
    while not why and len(tried) < ATTEMPTS:
        began = perf_counter()
        points, triangles, missing = search.mesh(fineness, search.limit)
        seconds = perf_counter() - began
        found = without_collapsed(triangles)
        if not len(found):
            why = "no triangles"
            break
        figures = _judged(truth, points, found, search.limit)
        tried.append((fineness, figures["reach"]))
        if figures["reach"] <= 1.0 and (not best or len(found) < best["triangles"]):
            shown = shape_figures(shapes(own_vertices(points, found)))
            best = {**figures, **shown, "missing": missing, "fineness": fineness}
            best["seconds"] = seconds
        search.say({**best, "tried": tried})
        further = next_fineness(tried, *search.bounds)
        if further is None:
            break
        growth = (further / fineness) ** 2
        if len(found) * growth > search.most:
            why = f"more than {search.most:,}"
        elif perf_counter() + DEAREST * growth * (perf_counter() - began) > search.until:
            why = "no time left"
        fineness = further
    row = {**best, "tried": tried, **({"cut_short": why} if why else {})}
    if not best:
        nearest = min((share for _, share in tried), default=math.inf)
        row["left_out"] = f"{why or 'not kept'}, at best {nearest:.2f} of the limit"
    return row


WORK = {
    "truth": _truth, "ours": _ours, "searched": _ours_searched,
    "gmsh": _gmsh, "netgen": _netgen, "ocp": _ocp,
}  # fmt: skip


if __name__ == "__main__":
    child_process.answer_by(WORK)
