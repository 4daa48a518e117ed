"""The work that ``speed.py`` times: each job in a process of its own, one thread, processor time.

A job is done request["times"] times after one that warms up, and the median counts. Shapes of all
meshers are measured by the same functions.
"""

import single_thread  # noqa: F401  (before numpy)

# isort: split
import math
import statistics
import time
from collections.abc import Callable
from typing import Any

import child_process
import gmsh_session
import numpy as np
import psutil

import surfmesh as sm
from surfmesh.quality.measures.shape import shapes

PLANE_GROWTH, SMALLEST_PART = 1.1, 0.2  # of the graded plane: largest over smallest size is 5
EQUILATERAL = np.sqrt(3.0) / 4.0  # area of the triangle of side 1
REFINEMENTS = 30  # of Triangle, at most
LOOSENED = 1.6  # Triangle takes areas as upper bounds: largest over mean, as measured
Mesh = tuple[np.ndarray, np.ndarray]
"""Points (n, 3) and triangles (m, 3)."""


def timed(
    request: dict,
    work: Callable[[], Any],
    before: Callable[[], object] = lambda: None,
    arrays: Callable[[Any], Mesh] = lambda mesh: mesh,
) -> dict:
    """Processor seconds (median) and shape of what ``work`` makes; the others are not timed."""
    seconds = []
    for _ in range(request["times"] + 1):
        before()
        start = time.process_time()
        mesh = work()
        seconds.append(time.process_time() - start)
    return {"seconds": statistics.median(seconds[1:]), **figures(*arrays(mesh))}


def figures(points: np.ndarray, triangles: np.ndarray) -> dict:
    used, corners = np.unique(triangles, return_inverse=True)
    mesh = sm.SurfaceMesh(points=points[used], triangles=corners.reshape(-1, 3))
    alpha = shapes(mesh).alpha
    return {
        "triangles": len(alpha),
        "alpha_mean": float(alpha.mean()),
        "alpha_p01": float(np.quantile(alpha, 0.01)),
        "alpha_min": float(alpha.min()),
    }


# CAD models: request["file"], request["size"]; others also request["wanted"], our triangles: their
# size is changed so that they make as many


def cad_surfmesh(request: dict) -> dict:
    model = sm.load(request["file"])

    def work() -> Mesh:
        mesh = sm.mesh(model, sm.Sizing(size=request["size"]), jobs=1)
        return mesh.points, mesh.triangles

    return timed(request, work) | {"faces": len(model.faces)}


def cad_gmsh(request: dict) -> dict:
    import gmsh

    gmsh_session.started()
    gmsh.model.occ.importShapes(request["file"])
    gmsh.model.occ.synchronize()

    def work(size: float) -> Mesh:
        gmsh.option.setNumber("Mesh.MeshSizeMin", size)
        gmsh.option.setNumber("Mesh.MeshSizeMax", size)
        return generated(gmsh)

    size = as_many(work, request)
    found = timed(request, lambda: work(size), gmsh.model.mesh.clear)
    return found | {"faces": len(gmsh.model.getEntities(2)), "size": size}


def cad_netgen(request: dict) -> dict:
    from netgen.meshing import MeshingStep
    from netgen.occ import OCCGeometry

    geometry = OCCGeometry(request["file"])

    def work(size: float):
        return geometry.GenerateMesh(maxh=size, perfstepsend=MeshingStep.MESHSURFACE)

    def arrays(mesh) -> Mesh:
        points = np.array([p.p for p in mesh.Points()])
        return points, np.array([[v.nr - 1 for v in e.vertices] for e in mesh.Elements2D()])

    size = as_many(lambda size: arrays(work(size)), request)
    return timed(request, lambda: work(size), arrays=arrays) | {"size": size}


def as_many(work: Callable[[float], Mesh], request: dict) -> float:
    """The size with which a mesher makes about request["wanted"] triangles."""
    size = request["size"]
    for _ in range(2):
        size *= math.sqrt(len(work(size)[1]) / request["wanted"])
    return size


def generated(gmsh) -> Mesh:
    gmsh.model.mesh.generate(2)
    tags, points, _ = gmsh.model.mesh.getNodes()
    place = np.zeros(int(tags.max()) + 1, np.int64)
    place[tags] = np.arange(len(tags))
    _, corners = gmsh.model.mesh.getElementsByType(2)
    return points.reshape(-1, 3), place[corners].reshape(-1, 3)


# the unit square with sizes that grow from its middle: request["size"] is the smallest


def plane_sizes(smallest: float) -> Callable[[np.ndarray], np.ndarray]:
    """smallest at the middle, five times as much at the corners, linear between."""
    slope = smallest * (1.0 / SMALLEST_PART - 1.0) / np.sqrt(0.5)
    return lambda points: smallest + slope * np.hypot(points[:, 0] - 0.5, points[:, 1] - 0.5)


def plane_surfmesh(request: dict) -> dict:
    plate = sm.PlanarDomain([[0, 0], [1, 0], [1, 1], [0, 1]], name="unit square")
    law = plane_sizes(request["size"])

    def work() -> Mesh:
        mesh = sm.mesh(plate, sm.Sizing(size=lambda p: law(p), growth=PLANE_GROWTH))
        return mesh.points, mesh.triangles

    return timed(request, work)


def plane_triangle(request: dict) -> dict:
    import triangle

    law = plane_sizes(request["size"])
    square = np.array([[0, 0], [1, 0], [1, 1], [0, 1]], float)
    sides = np.array([[0, 1], [1, 2], [2, 3], [3, 0]])

    def work() -> Mesh:
        made = triangle.triangulate({"vertices": square.copy(), "segments": sides.copy()}, "pq30")
        for _ in range(REFINEMENTS):
            corners = made["vertices"][made["triangles"]]
            most = LOOSENED * EQUILATERAL * law(corners.mean(axis=1)) ** 2
            u, v = corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]
            if (0.5 * (u[:, 0] * v[:, 1] - u[:, 1] * v[:, 0]) <= most).all():
                break
            made["triangle_max_area"] = most[:, None]
            made = triangle.triangulate(made, "rpq30a")
        return np.pad(made["vertices"], ((0, 0), (0, 1))), made["triangles"]

    return timed(request, work)


def plane_gmsh(request: dict) -> dict:
    """The sizes as one of gmsh's own formulas: nothing is asked of Python."""
    import gmsh

    gmsh_session.started()
    gmsh.model.occ.addRectangle(0, 0, 0, 1, 1)
    gmsh.model.occ.synchronize()
    slope = request["size"] * (1.0 / SMALLEST_PART - 1.0) / np.sqrt(0.5)
    law = gmsh.model.mesh.field.add("MathEval")
    formula = f"{request['size']:.17g} + {slope:.17g} * Sqrt((x-0.5)*(x-0.5) + (y-0.5)*(y-0.5))"
    gmsh.model.mesh.field.setString(law, "F", formula)
    gmsh.model.mesh.field.setAsBackgroundMesh(law)
    return timed(request, lambda: generated(gmsh), gmsh.model.mesh.clear)


# surfaces of formulas: request["name"], request["sizing"]


def surface_surfmesh(request: dict) -> dict:
    surface, sizing = sm.load(request["name"]), sm.Sizing(**request["sizing"])
    stages: list[dict] = []

    def work() -> Mesh:
        mesh = sm.mesh(surface, sizing)
        stages.append(dict(mesh.seconds))
        return mesh.points, mesh.triangles

    return timed(request, work) | {"stages": stages[-1]}


# one mesh alone: what it takes of memory over the interpreter with everything loaded


def memory_surfmesh(request: dict) -> dict:
    from memory import _peak

    surface = sm.load(request["name"])
    sm.mesh(surface, sm.Sizing(chord=1e3 * request["sizing"]["chord"]))
    own = psutil.Process().memory_info().rss
    start = time.process_time()
    mesh = sm.mesh(surface, sm.Sizing(**request["sizing"]))
    seconds = time.process_time() - start
    return {
        "triangles": len(mesh.triangles),
        "seconds": seconds,
        "gigabytes": (_peak() - own) / 1e9,
    }


# two cores: the clock on the wall


def cores_surfmesh(request: dict) -> dict:
    made = sm.load(request["file"]) if "file" in request else sm.load(request["name"])
    sizing = sm.Sizing(**request["sizing"])
    sm.mesh(made, sm.Sizing(**request["warm"]))
    seconds: dict[int, list[float]] = {1: [], 2: []}
    for _ in range(request["times"]):
        for jobs in seconds:  # in turn: what else the machine does falls on both
            start = time.perf_counter()
            mesh = sm.mesh(made, sizing, jobs=jobs)
            seconds[jobs].append(time.perf_counter() - start)
    one, two = (statistics.median(seconds[jobs]) for jobs in (1, 2))
    return {"one": one, "two": two, "ratio": one / two, "triangles": len(mesh.triangles)}


# what is asked of a surface or a model before and after it is meshed: seconds of all three


def checked_model(request: dict) -> dict:
    return checked(request, sm.load(request["file"]), sm.Sizing(size=request["size"]))


def checked_surface(request: dict) -> dict:
    return checked(request, sm.load(request["name"]), sm.Sizing(**request["sizing"]))


def checked(request: dict, subject: Any, sizing: sm.Sizing) -> dict:
    found: dict[str, list[float]] = {"mesh": [], "check": [], "estimate": []}
    for _ in range(request["times"] + 1):
        start = time.process_time()
        mesh = sm.mesh(subject, sizing, jobs=1)
        meshed = time.process_time()
        sm.check(mesh)
        checked = time.process_time()
        sm.estimate(subject, sizing)
        done = time.process_time()
        for name, seconds in zip(found, (meshed - start, checked - meshed, done - checked)):
            found[name].append(seconds)
    return {name: statistics.median(every[1:]) for name, every in found.items()}


JOBS = (
    cad_surfmesh, cad_gmsh, cad_netgen, plane_surfmesh, plane_triangle, plane_gmsh,
    surface_surfmesh, memory_surfmesh, cores_surfmesh,
    checked_model, checked_surface,
)  # fmt: skip


def run(job: str, timeout: float, **request: object) -> dict:
    """What the job says, or {"error": the reason}."""
    return child_process.run("speed_jobs.py", {"mesher": job, **request}, timeout)


if __name__ == "__main__":
    child_process.answer_by({job.__name__: job for job in JOBS})
