"""Laplace-Beltrami eigenvalues of the unit sphere, l (l + 1), on meshes of surfmesh and gmsh.

    python benchmarks/eigenvalues.py [--sizes 0.4 0.2 0.1 0.05] [--json outputs/eigenvalues.json]

Linear elements on the flat triangles; the error of the multiplet l is that of the mean of its
2 l + 1 values, relative. gmsh gets the size that gives about as many triangles. The rate is that
of the error in the mean edge length, between one mesh and the next: 2 is right.
"""

import argparse
import json
import math
from pathlib import Path

import numpy as np
import single_thread  # noqa: F401 - first
from rich.box import SIMPLE_HEAD
from rich.table import Table
from scipy.sparse import coo_matrix
from scipy.sparse.linalg import eigsh
from tables import console, heading, note

import surfmesh as sm

MULTIPLETS = (1, 2, 3, 4)


def eigenvalues(points: np.ndarray, triangles: np.ndarray, count: int) -> np.ndarray:
    """The smallest eigenvalues of stiffness against mass, linear elements."""
    corners = points[triangles]
    opposite = np.roll(corners, -1, axis=1) - np.roll(corners, -2, axis=1)  # edge facing corner i
    area = 0.5 * np.linalg.norm(np.cross(opposite[:, 0], opposite[:, 1]), axis=1)
    stiffness = np.einsum("tid,tjd->tij", opposite, opposite) / (4.0 * area)[:, None, None]
    mass = (np.ones((3, 3)) + np.eye(3)) * (area / 12.0)[:, None, None]
    rows, columns = (np.repeat(triangles, 3, axis=1), np.tile(triangles, (1, 3)))
    shape = (len(points), len(points))
    k, m = (
        coo_matrix((part.reshape(-1), (rows.ravel(), columns.ravel())), shape).tocsc()
        for part in (stiffness, mass)
    )
    return np.sort(eigsh(k, count, m, sigma=-0.1, return_eigenvectors=False))


def errors(points: np.ndarray, triangles: np.ndarray) -> dict[str, float]:
    """Relative errors by multiplet, with the mean edge length."""
    found = eigenvalues(points, triangles, (MULTIPLETS[-1] + 1) ** 2)
    row = {
        f"l={l}": float(found[l * l : (l + 1) ** 2].mean() / (l * (l + 1)) - 1.0)
        for l in MULTIPLETS
    }
    sides = points[np.roll(triangles, -1, axis=1)] - points[triangles]
    return {"triangles": len(triangles), "edge": float(np.linalg.norm(sides, axis=2).mean())} | row


def by_gmsh(size: float) -> tuple[np.ndarray, np.ndarray]:
    """The unit sphere, one edge length everywhere."""
    import gmsh

    gmsh.initialize(interruptible=False)
    try:
        gmsh.option.setNumber("General.Terminal", 0)
        gmsh.model.occ.addSphere(0.0, 0.0, 0.0, 1.0)
        gmsh.model.occ.synchronize()
        for name in ("MeshSizeMin", "MeshSizeMax"):
            gmsh.option.setNumber(f"Mesh.{name}", size)
        gmsh.model.mesh.generate(2)
        tags, xyz, _ = gmsh.model.mesh.getNodes()
        number = np.zeros(int(tags.max()) + 1, np.int64)
        number[tags] = np.arange(len(tags))
        triangles = number[gmsh.model.mesh.getElementsByType(2)[1].reshape(-1, 3)]
        used, rows = np.unique(triangles, return_inverse=True)
        return xyz.reshape(-1, 3)[used], rows.reshape(-1, 3)
    finally:
        gmsh.finalize()


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--sizes", nargs="+", type=float, default=[0.4, 0.2, 0.1, 0.05])
    parser.add_argument("--json", type=Path)
    options = parser.parse_args()
    results: dict[str, list[dict[str, float]]] = {"surfmesh": [], "gmsh": []}
    for size in options.sizes:
        mesh = sm.mesh(sm.load("sphere"), size)
        points = mesh.points / np.linalg.norm(mesh.points, axis=1).mean()
        ours = errors(points, mesh.triangles)
        theirs = errors(*by_gmsh(size))
        for _ in range(2):  # to our number of triangles
            size *= math.sqrt(theirs["triangles"] / ours["triangles"])
            theirs = errors(*by_gmsh(size))
        results["surfmesh"].append(ours)
        results["gmsh"].append(theirs)
    heading("Relative error of l (l + 1) on the unit sphere")
    for name, rows in results.items():
        table = Table(box=SIMPLE_HEAD)
        for title in (name, "edge", *(f"l={l}" for l in MULTIPLETS), "rate of l=1"):
            table.add_column(title, justify="right")
        before = None
        for row in rows:
            rate = ""
            if before is not None:
                fewer = math.log(before["edge"] / row["edge"])
                rate = f"{math.log(before['l=1'] / row['l=1']) / fewer:.2f}"
            figures = [f"{row[f'l={l}']:.3e}" for l in MULTIPLETS]
            table.add_row(f"{row['triangles']:,}", f"{row['edge']:.4f}", *figures, rate)
            before = row
        console.print(table)
    note("gmsh's size is scaled until its number of triangles is about ours")
    if options.json:
        options.json.write_text(json.dumps(results, indent=1) + "\n", encoding="utf-8")


if __name__ == "__main__":
    main()
