"""A judge of meshes of parametric surfaces: against the formulas, evaluated by sympy and numpy."""

from __future__ import annotations

from dataclasses import dataclass, field
from functools import cached_property
from typing import Any

import numpy as np
import shapely
import sympy
import trimesh

from judge.distances import farthest, farthest_point
from judge.index_topology import border_loops, euler_number, faults_of_indices
from judge.orientation import reversed_triangles
from judge.piercing import folded, piercing
from judge.verdict import Verdict

PANELS, NODES = 24, 8  # of the quadrature by Gauss and Legendre each way
CELLS = (120, 240, 480)  # each way, of the tessellations that stand for the truth
FINE = 0.05  # of the chord: how near they shall be
AREA = 0.05  # relative error that chord and angles of a coarse mesh explain
AREA_BY_SIZE = 0.15  # the same where a size alone is asked for, however much the surface bends
SAFETY = 1.5


@dataclass(frozen=True)
class Truth:
    """A surface by its formulas, and what is known of its topology."""

    formulas: tuple[str, str, str]
    """In u and v, in sympy's words."""
    u: tuple[float, float]
    v: tuple[float, float]
    loops: tuple[np.ndarray, ...] = ()
    """(k, 2) each: inside an odd number of them is what is left; none: all."""
    euler: int = 1
    borders: int = 1
    oriented: bool = True
    embedded: bool = True
    """No two places of it meet, so that edges pierce nothing."""
    facts: dict[str, Any] = field(default_factory=dict)

    @cached_property
    def _functions(self) -> tuple[Any, Any, Any]:
        u, v = sympy.symbols("u v", real=True)
        r = [sympy.sympify(text, locals={"u": u, "v": v}) for text in self.formulas]
        made = [
            sympy.lambdify((u, v), [sympy.diff(x, by) if by else x for x in r], "numpy")
            for by in (None, u, v)
        ]
        return made[0], made[1], made[2]

    def evaluate(self, uv: np.ndarray) -> list[np.ndarray]:
        """uv (n, 2) -> r, r_u, r_v, each (n, 3)."""
        with np.errstate(all="ignore"):
            return [
                np.column_stack([np.broadcast_to(x, len(uv)) for x in f(*uv.T)]).astype(float)
                for f in self._functions
            ]

    def inside(self, uv: np.ndarray) -> np.ndarray:
        """(n,) whether places of the rectangle are left by the loops."""
        if not self.loops:
            return np.ones(len(uv), bool)
        within = [shapely.contains_xy(shapely.Polygon(loop), *uv.T) for loop in self.loops]
        return np.sum(within, axis=0) % 2 == 1

    @cached_property
    def contents(self) -> tuple[float, float]:
        """Area, and volume within it if it is closed; of the whole rectangle."""
        nodes, weights = np.polynomial.legendre.leggauss(NODES)
        grids = []
        for first, last in (self.u, self.v):
            step = (last - first) / PANELS
            middle = first + step * (np.arange(PANELS) + 0.5)
            grids.append((
                (middle[:, None] + 0.5 * step * nodes).ravel(),
                np.tile(0.5 * step * weights, PANELS),
            ))  # fmt: skip
        (u, wu), (v, wv) = grids
        uv = np.stack(np.meshgrid(u, v, indexing="ij"), axis=-1).reshape(-1, 2)
        r, r_u, r_v = self.evaluate(uv)
        normal = np.cross(r_u, r_v)
        weight = np.outer(wu, wv).ravel()
        area = weight @ np.linalg.norm(normal, axis=1)
        return float(area), float(weight @ np.einsum("ij,ij->i", r, normal)) / 3.0

    def tessellated(self, near: float) -> tuple[trimesh.Trimesh, np.ndarray, float]:
        """Triangles of the rectangle, the (u, v) of their corners, and how far they are off."""
        for cells in CELLS:
            lines = [np.linspace(*span, 2 * cells + 1) for span in (self.u, self.v)]
            uv = np.stack(np.meshgrid(*lines, indexing="ij"), axis=-1)
            r = self.evaluate(uv.reshape(-1, 2))[0].reshape(*uv.shape[:2], 3)
            # by the middle of each diagonal: of a quadratic, the farthest place of the triangle
            off = r[1::2, 1::2] - 0.5 * (r[:-1:2, :-1:2] + r[2::2, 2::2])
            off = float(np.linalg.norm(off, axis=2).max())
            if off <= near:
                break
        number = np.arange((cells + 1) ** 2).reshape(cells + 1, cells + 1)
        a, b, c, d = number[:-1, :-1], number[1:, :-1], number[1:, 1:], number[:-1, 1:]
        corners = np.stack([a, b, c, a, c, d], axis=-1).reshape(-1, 3)
        coarse = r[::2, ::2].reshape(-1, 3)
        sides = coarse[corners]
        flat = np.linalg.norm(
            np.cross(sides[:, 1] - sides[:, 0], sides[:, 2] - sides[:, 0]), axis=1
        )
        corners = corners[flat > 0.0]
        mesh = trimesh.Trimesh(coarse, corners, process=False)
        return mesh, uv[::2, ::2].reshape(-1, 2), off


def judged(points: np.ndarray, triangles: np.ndarray, truth: Truth, chord: float | None) -> Verdict:
    """What is wrong with a mesh of a parametric surface, in words, and the figures."""
    closed = truth.borders == 0
    faults = faults_of_indices(points, triangles, closed=closed, oriented=truth.oriented)
    for name, found, wanted in (
        ("Euler number", euler_number(triangles), truth.euler),
        ("borders:", border_loops(triangles), truth.borders),
    ):
        if found != wanted:
            faults.append(f"{name} {found} of {wanted}")
    mesh = trimesh.Trimesh(points, triangles, process=False)
    area, volume = truth.contents
    figures = {}
    if not truth.loops:
        figures["area_error"] = mesh.area / area - 1.0
        if abs(mesh.area / area - 1.0) > (AREA_BY_SIZE if chord is None else AREA):
            faults.append(f"area {mesh.area:.6g} of {area:.6g}")
        if closed and truth.oriented and chord is not None:
            if abs(mesh.volume - volume) > SAFETY * chord * area + 1e-6 * abs(volume):
                faults.append(f"volume {mesh.volume:.6g} of {volume:.6g}")
    if truth.embedded:
        pierced = piercing(points, triangles)
        if pierced:
            faults.append(f"{pierced} edges pierce triangles")
    lying = folded(points, triangles)
    if lying:
        faults.append(f"{lying} triangles lie folded on a neighbour")
    near = FINE * (chord if chord is not None else 0.01 * float(mesh.scale))
    exact, uv, off = truth.tessellated(near)
    against = reversed_triangles(mesh, exact) if truth.oriented else 0
    if against:
        faults.append(f"{against} triangles look the wrong way")
    if chord is not None:
        there, back = farthest(mesh, exact) / chord, _back(mesh, exact, uv, truth) / chord
        figures.update(to_surface=there, to_mesh=back, deviation=max(there, back))
        allowed = 1.01 + off / chord
        for way, far in (("from mesh to surface", there), ("from surface to mesh", back)):
            if far > allowed:
                faults.append(f"{far:.3g} chord {way}")
    return Verdict(tuple(faults), figures)


def _back(mesh: trimesh.Trimesh, exact: trimesh.Trimesh, uv: np.ndarray, truth: Truth) -> float:
    """Largest distance of what the loops leave of the surface from the mesh."""
    kept = np.flatnonzero(truth.inside(uv))
    kept = kept[:: len(kept) // 60_000 + 1]
    return farthest_point(exact.vertices[kept], mesh)
