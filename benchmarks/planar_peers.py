"""Meshers of planar domains, ours among them, each in a process of its own.

surfmesh   ``sm.mesh``
triangle   Shewchuk's Triangle: "pq30a" for a uniform size; a graded one by refinement with the
           largest area a triangle may have at its centroid, until none is larger
loosened   Triangle with these areas 1.6 times as large, which gives about as many triangles as
           the sizes mean: an upper bound alone makes them smaller and more
gmsh       Frontal-Delaunay; asks for a graded size point by point, the seconds spent in answering
           are taken off its time; those of the other two hold theirs

The triangles of all three are judged by the same functions, with the sizes wanted at their
vertices by the same law.
"""

import single_thread  # noqa: F401  (before numpy)

# isort: split
import sys
import time

import child_process
import gmsh_session
import numpy as np

import surfmesh as sm
from surfmesh.geometry.planar.planar_domain import PlanarDomain
from surfmesh.quality.measures.lengths import QUASI_UNIT, edge_figures
from surfmesh.quality.measures.shape import shapes
from surfmesh.sizing.options.distance_size import DistanceSize

LAWS = ("uniform", "graded")
GRADING = 6.0  # largest over smallest of the graded sizes
REACH = 0.15  # of the width of the domain
GROWTH = 1.2
REFINEMENTS = 30  # at most
SIDES = 32  # of the round hole
LOOSENED = 1.6  # largest over mean area of Triangle's triangles, as measured at 10 and 100 thousand
EQUILATERAL = np.sqrt(3.0) / 4.0  # area of the triangle of side 1

Triangles = tuple[np.ndarray, np.ndarray, float]
"""Points (n, 2), triangles (m, 3) and the seconds they took."""


def peer(mesher: str, law: str, scale: float, timeout: float) -> dict:
    """Quality and speed of one mesher, or {"error": the reason}.

    scale: the edge length wanted (uniform), or the smallest one (graded).
    """
    request = {"mesher": mesher, "law": law, "scale": scale}
    return child_process.run("planar_peers.py", request, timeout)


def domain() -> PlanarDomain:
    """A unit square with a round and a square hole."""
    angle = 2.0 * np.pi * np.arange(SIDES) / SIDES
    round_hole = np.array([0.3, 0.35]) + 0.12 * np.stack([np.cos(angle), np.sin(angle)], axis=1)
    square = np.array([[0, 0], [1, 0], [1, 1], [0, 1]], float)
    return PlanarDomain(square, [round_hole, [0.6, 0.6] + 0.2 * square], name="square with holes")


def size_law(plate: PlanarDomain, law: str, scale: float):
    """Edge lengths wanted at points (n, 2) -> (n,)."""
    if law == "uniform":
        return lambda points: np.full(len(points), scale)
    return DistanceSize(plate, near=scale, far=GRADING * scale, reach=REACH)


def surfmesh(plate: PlanarDomain, law: str, scale: float) -> Triangles:
    sizes = scale if law == "uniform" else size_law(plate, law, scale)
    sm.mesh(plate, 0.2)  # imports, outside the clock

    def progress(stage: str, fraction: float) -> None:
        print(f"  surfmesh: {stage} {fraction:.0%}", file=sys.stderr)

    start = time.perf_counter()
    mesh = sm.mesh(plate, sm.Sizing(size=sizes, growth=GROWTH), progress=progress)
    return mesh.points[:, :2], mesh.triangles, time.perf_counter() - start


def loosened(plate: PlanarDomain, law: str, scale: float) -> Triangles:
    return triangle(plate, law, scale, LOOSENED)


def triangle(plate: PlanarDomain, law: str, scale: float, factor: float = 1.0) -> Triangles:
    import triangle as shewchuk

    sizes = size_law(plate, law, scale)
    graph = plate.graph
    holes = np.array([hole.mean(axis=0) for hole in plate.holes])
    given = {"vertices": graph.points.copy(), "segments": graph.segments.copy(), "holes": holes}
    start = time.perf_counter()
    if law == "uniform":
        made = shewchuk.triangulate(given, f"pq30a{factor * EQUILATERAL * scale**2:.17f}")
        return made["vertices"], made["triangles"], time.perf_counter() - start
    made = shewchuk.triangulate(given, "pq30")
    for _ in range(REFINEMENTS):
        corners = made["vertices"][made["triangles"]]
        most = factor * EQUILATERAL * sizes(corners.mean(axis=1)) ** 2
        u, v = corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]
        if (0.5 * (u[:, 0] * v[:, 1] - u[:, 1] * v[:, 0]) <= most).all():
            break
        made["triangle_max_area"] = most[:, None]
        made = shewchuk.triangulate(made, "rpq30a")
    return made["vertices"], made["triangles"], time.perf_counter() - start


def gmsh(plate: PlanarDomain, law: str, scale: float) -> Triangles:
    import gmsh

    sizes = size_law(plate, law, scale)
    gmsh_session.started()
    geo = gmsh.model.geo
    loops = []
    for loop in (*plate.outer, *plate.holes):
        points = [geo.addPoint(x, y, 0.0) for x, y in loop]
        lines = [geo.addLine(a, b) for a, b in zip(points, points[1:] + points[:1])]
        loops.append(geo.addCurveLoop(lines))
    face = geo.addPlaneSurface(loops)
    geo.synchronize()
    answering = 0.0

    def size(dim: int, tag: int, x: float, y: float, z: float, lc: float) -> float:
        nonlocal answering
        begun = time.perf_counter()
        wanted = float(sizes(np.array([[x, y]]))[0])
        answering += time.perf_counter() - begun
        return wanted

    if law == "uniform":
        gmsh.option.setNumber("Mesh.MeshSizeMin", scale)
        gmsh.option.setNumber("Mesh.MeshSizeMax", scale)
    else:
        gmsh.model.mesh.setSizeCallback(size)
    start = time.perf_counter()
    gmsh.model.mesh.generate(2)
    seconds = time.perf_counter() - start - answering
    tags, points, _ = gmsh.model.mesh.getNodes(2, face, includeBoundary=True)
    tags, first = np.unique(tags, return_index=True)
    kinds, _, corners = gmsh.model.mesh.getElements(2, face)
    triangles = np.searchsorted(tags, corners[list(kinds).index(2)]).reshape(-1, 3)
    gmsh.finalize()
    return points.reshape(-1, 3)[first, :2], triangles, seconds


MESHERS = {"surfmesh": surfmesh, "triangle": triangle, "loosened": loosened, "gmsh": gmsh}


def _measure(request: dict) -> dict:
    plate, law, scale = domain(), request["law"], request["scale"]
    points, triangles, seconds = MESHERS[request["mesher"]](plate, law, scale)
    mesh = sm.SurfaceMesh(
        points=np.column_stack([points, np.zeros(len(points))]),
        triangles=triangles,
        sizes=size_law(plate, law, scale)(points),
    )
    shape = shapes(mesh)
    unit = edge_figures(mesh).metric_lengths
    return {
        "triangles": len(triangles),
        "alpha_mean": float(shape.alpha.mean()),
        "alpha_min": float(shape.alpha.min()),
        "min_angle_deg": float(np.min(shape.min_angle)),
        "quasi_unit_share": float(((unit >= QUASI_UNIT[0]) & (unit <= QUASI_UNIT[1])).mean()),
        "length_mean": float(unit.mean()),
        "length_std": float(unit.std()),
        "seconds": seconds,
        "triangles_a_second": len(triangles) / seconds,
    }


if __name__ == "__main__":
    child_process.answer(_measure)
