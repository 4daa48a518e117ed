"""Other meshers on the same surface with the same wanted sizes, each in a process of its own.

gmsh spline     Frontal-Delaunay on a B-spline surface fitted to the formulas
gmsh formulas   Frontal-Delaunay on gmsh's own ParametricSurface
mmgs            MMGS remeshing a fine grid of the surface

Their triangles go through surfmesh's own report: the vertices get the (u, v) of their nearest
surface points and the sizes that surfmesh's field wants there. gmsh asks for the wanted size
point by point; the seconds spent in answering are taken off its time. Seconds are the processor's.
"""

import single_thread  # noqa: F401  (before numpy)

# isort: split
import time
from collections.abc import Callable

import child_process
import gmsh_session
import numpy as np

import surfmesh as sm
from surfmesh.geometry.differential.projection import closest_point
from surfmesh.geometry.surface import Surface
from surfmesh.sizing.field.size_field import SizeField

SPLINE_GRID = 160  # points each way that the spline interpolates
GUESS_GRID = 400  # points each way from which nearest points are sought


def peer(mesher: str, name: str, sizing: dict, expected: int, timeout: float) -> dict:
    """Quality and speed of one mesher, or {"error": the reason}."""
    request = {"mesher": mesher, "name": name, "sizing": sizing, "expected": expected}
    return child_process.run("peers.py", request, timeout)


class WantedSize:
    """The size wanted at points in space: by the nearest point of a grid, then one Newton step.

    The grid is even in the scaled plane, where speeds are about one.
    """

    def __init__(self, surface: Surface, field: SizeField) -> None:
        from scipy.spatial import cKDTree

        self.surface, self.field = surface, field
        width, height = field.chart.extent
        self.xy = _lattice(((0.0, width), (0.0, height)), GUESS_GRID)
        self.uv = field.chart.to_uv(self.xy)
        rates = field.chart.rates(self.xy)
        self.point, r_u, r_v = surface.evaluate(self.uv, 1)
        self.tree = cKDTree(self.point)
        jacobian = np.stack([r_u * rates[:, :1], r_v * rates[:, 1:]], axis=2)
        self.inverse = np.linalg.pinv(jacobian, rcond=1e-6)
        self.seconds = 0.0

    def __call__(self, dim: int, tag: int, x: float, y: float, z: float, size: float) -> float:
        """As gmsh calls it; keeps the seconds that the answers take."""
        start = time.process_time()
        p = np.array((x, y, z))
        i = self.tree.query(p)[1]
        x, y = self.xy[i] + self.inverse[i] @ (p - self.point[i])
        wanted = float(self.field.background.scalar_sizes(np.array([[x, y]]))[0])
        self.seconds += time.process_time() - start
        return wanted

    def at(self, uv: np.ndarray) -> np.ndarray:
        """(n,) sizes wanted at uv (n, 2)."""
        return self.field.sizes(self.field.chart.to_plane(uv))

    def corner_parameters(self, points: np.ndarray, triangles: np.ndarray) -> np.ndarray:
        """(m, 3, 2) of the surface points nearest to the corners, each triangle in one piece.

        Sought from the centroid's: across a seam the corners lie a little outside the domain.
        """
        centre = points[triangles].mean(axis=1)
        guess = np.repeat(self.uv[self.tree.query(centre)[1]], 3, axis=0)
        corners = points[triangles.ravel()]
        found = closest_point(self.surface, corners, guess, steps=12, margin=0.25)[0]
        return found.reshape(-1, 3, 2)


def _lattice(domain: tuple, n: int) -> np.ndarray:
    """(n * n, 2) evenly spaced points of a rectangle."""
    lines = [np.linspace(a, b, n) for a, b in domain]
    return np.stack(np.meshgrid(*lines, indexing="ij"), axis=-1).reshape(-1, 2)


Triangles = tuple[np.ndarray, np.ndarray, float]
"""Points (n, 3), triangles (m, 3) and the seconds they took."""


def gmsh_spline(surface: Surface, size: WantedSize, expected: int) -> Triangles:
    """On an OpenCASCADE B-spline surface that interpolates a grid of surface points."""
    from scipy.interpolate import RectBivariateSpline

    def geometry(gmsh) -> int:
        u, v = (np.linspace(a, b, SPLINE_GRID) for a, b in surface.domain)
        (points,) = surface.evaluate(_lattice(surface.domain, SPLINE_GRID), 0)
        points = points.reshape(SPLINE_GRID, SPLINE_GRID, 3)
        splines = [RectBivariateSpline(u, v, points[..., k], s=0) for k in range(3)]
        poles = np.stack([s.get_coeffs().reshape(SPLINE_GRID, -1) for s in splines], axis=-1)
        occ = gmsh.model.occ
        tags = [occ.addPoint(*pole) for row in poles.transpose(1, 0, 2) for pole in row]
        knots = [np.unique(t, return_counts=True) for t in splines[0].get_knots()]
        face = occ.addBSplineSurface(
            tags, SPLINE_GRID, degreeU=3, degreeV=3,
            knotsU=knots[0][0].tolist(), multiplicitiesU=knots[0][1].tolist(),
            knotsV=knots[1][0].tolist(), multiplicitiesV=knots[1][1].tolist(),
        )  # fmt: skip
        occ.remove([(0, tag) for tag in tags])
        occ.synchronize()
        return face

    return _by_gmsh(geometry, size)


def gmsh_formulas(surface: Surface, size: WantedSize, expected: int) -> Triangles:
    """On gmsh's own ParametricSurface, from the same formulas."""

    def geometry(gmsh) -> int:
        (u0, u1), (v0, v1) = surface.domain
        geo = gmsh.model.geo
        texts = [_as_gmsh_writes(formula, surface.parameters) for formula in surface.formulas]
        on = geo.addGeometry("ParametricSurface", strings=texts)
        corners = ((u0, v0), (u1, v0), (u1, v1), (u0, v1))
        point = [geo.addPointOnGeometry(on, *corner) for corner in corners]
        lines = [geo.addLine(point[i], point[(i + 1) % 4]) for i in range(4)]
        face = geo.addPlaneSurface([geo.addCurveLoop(lines)])
        geo.synchronize()
        middle = np.array([[0.5 * (u0 + u1) + 0.1 * (u1 - u0), 0.5 * (v0 + v1)]])
        there = gmsh.model.getValue(2, face, middle[0])
        if not np.allclose(there, surface.evaluate(middle, 0)[0][0], rtol=1e-4):
            raise RuntimeError("gmsh reads the formulas differently")
        return face

    return _by_gmsh(geometry, size)


def _as_gmsh_writes(formula: str, parameters: dict) -> str:
    """The formula with ^ for powers, and brackets: gmsh takes -u^2 for (-u)^2."""
    from sympy.printing.str import StrPrinter

    from surfmesh.geometry.formulas.expression import parse

    class Printer(StrPrinter):
        def _print_Pow(self, power, rational=False):
            return f"(({self._print(power.base)})^({self._print(power.exp)}))"

    expression = parse(formula, ("u", "v"), parameters)
    numbers = {s: parameters[str(s)] for s in expression.free_symbols if str(s) in parameters}
    return Printer().doprint(expression.subs(numbers).evalf())


def _by_gmsh(geometry: Callable, size: WantedSize) -> Triangles:
    import gmsh

    gmsh_session.started()
    face = geometry(gmsh)
    gmsh.model.mesh.setSizeCallback(size)
    start = time.process_time()
    gmsh.model.mesh.generate(2)
    seconds = time.process_time() - start - size.seconds
    tags, points, _ = gmsh.model.mesh.getNodes(2, face, includeBoundary=True)
    tags, first = np.unique(tags, return_index=True)
    kinds, _, corners = gmsh.model.mesh.getElements(2, face)
    if 2 not in kinds:
        raise RuntimeError("no triangles were made")
    triangles = np.searchsorted(tags, corners[list(kinds).index(2)]).reshape(-1, 3)
    gmsh.finalize()
    return points.reshape(-1, 3)[first], triangles, seconds


def mmgs(surface: Surface, size: WantedSize, expected: int) -> Triangles:
    """From a grid of the surface with about eight times as many triangles as are wanted.

    The size map alone decides (a loose Hausdorff distance, no gradation of its own): the
    setting that gave the best figures.
    """
    from mmgpy import MmgMeshS

    n = int(np.clip(2.0 * np.sqrt(expected), 100, 1000))
    uv = _lattice(surface.domain, n)
    (points,) = surface.evaluate(uv, 0)
    a = np.arange(n * n, dtype=np.int32).reshape(n, n)[:-1, :-1].ravel()
    b, c, d = a + n, a + n + 1, a + 1
    grid = np.concatenate([np.stack([a, b, c], 1), np.stack([a, c, d], 1)])
    wanted = size.at(uv)
    mesh = MmgMeshS(points, grid)
    mesh["metric"] = wanted[:, None]
    start = time.process_time()
    mesh.remesh(hausd=10.0 * float(wanted.max()), hgrad=-1.0, verbose=-1)
    seconds = time.process_time() - start
    return mesh.get_vertices(), mesh.get_triangles(), seconds


MESHERS = {"gmsh spline": gmsh_spline, "gmsh formulas": gmsh_formulas, "mmgs": mmgs}


def _measure(request: dict) -> dict:
    from measures import field_of, quality

    surface = sm.load(request["name"])
    if surface.loops:
        return {"error": "trimming loops are not handed to other meshers"}
    size = WantedSize(surface, field_of(surface, request["sizing"]))
    points, triangles, seconds = MESHERS[request["mesher"]](surface, size, request["expected"])
    triangles = triangles[_cornered(points, triangles)]
    used, corners = np.unique(triangles, return_inverse=True)
    points, triangles = points[used], corners.reshape(-1, 3)
    uv = size.corner_parameters(points, triangles)
    if _looks_backwards(surface, points, triangles, uv):  # a matter of taste
        triangles, uv = triangles[:, ::-1], uv[:, ::-1]
    vertex_uv = np.empty((len(points), 2))
    vertex_uv[triangles] = uv
    lo, hi = np.array(surface.domain).T
    report = sm.check(
        sm.SurfaceMesh(
            points=points,
            triangles=triangles,
            uv_points=uv.reshape(-1, 2),
            uv_triangles=np.arange(triangles.size).reshape(-1, 3),
            surfaces=(surface,),
            sizes=size.at(np.clip(vertex_uv, lo, hi)),
            sizing=size.field.sizing,
        )
    )
    return {
        **quality(report),
        "seconds_total": seconds,
        "triangles_a_second": report.triangles / seconds,
    }


def _cornered(points: np.ndarray, triangles: np.ndarray) -> np.ndarray:
    """Triangles with three distinct corners: gmsh makes others at a pole."""
    a, b, c = (points[corner] for corner in triangles.T)
    return (a != b).any(axis=1) & (b != c).any(axis=1) & (c != a).any(axis=1)


def _looks_backwards(
    surface: Surface, points: np.ndarray, triangles: np.ndarray, uv: np.ndarray
) -> bool:
    """Do most triangles look against r_u x r_v?"""
    _, r_u, r_v = surface.evaluate(uv.mean(axis=1), 1)
    a, b, c = (points[corner] for corner in triangles.T)
    along = np.einsum("ij,ij->i", np.cross(b - a, c - a), np.cross(r_u, r_v))
    return bool(np.median(along) < 0)


if __name__ == "__main__":
    child_process.answer(_measure)
