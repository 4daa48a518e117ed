"""Triangles of other meshers for the same distance from a sphere and a torus.

    python benchmarks/equal_deviation.py

A mesh for a chord of a thousandth of the diagonal is measured at 66 places of each triangle, by the
distance from the sphere or torus in closed form. The linear deflection of OCP's BRepMesh and the
triangles that gmsh puts on a turn are then tried from coarse to fine: the fewest triangles that are
as near. Of gmsh few values are tried, and its counts depend on which. A line for each: triangles,
and the distance / chord. Triangles follow each other along these surfaces, so that the distance the
other way is the same to second order.
"""

import single_thread  # noqa: F401  (before numpy)

# isort: split
from collections.abc import Callable

import cadquery as cq
import numpy as np
from numpy.typing import NDArray

import surfmesh as sm

FRACTION = 1_000
OF_OCP, OF_GMSH = 80, 20  # values that are tried: distances do not fall steadily
AT_ONCE = 20_000  # triangles
PLACES = np.array([(a, b, 10 - a - b) for a in range(11) for b in range(11 - a)]) / 10

Mesh = tuple[NDArray[np.float64], NDArray[np.integer]]
SHAPES = {
    "sphere": cq.Workplane().sphere(1),
    "torus": cq.Workplane(obj=cq.Solid.makeTorus(3, 1)),
}


def main() -> None:
    for name, shape in SHAPES.items():
        model = sm.from_cadquery(shape)
        chord = model.diagonal / FRACTION
        made = {}
        for ratio in (1.0, 100.0):
            mesh = sm.mesh(model, sm.Sizing(chord=chord, anisotropy=ratio))
            made[ratio] = distance(name, (mesh.points, mesh.triangles))
            show(name, f"surfmesh, ratio {ratio:g}", len(mesh.triangles), made[ratio] / chord)
        equal = made[1.0]
        for mesher, make, values in (
            ("OCP BRepMesh", of_ocp, np.geomspace(2.0, 0.1, OF_OCP) * chord),
            ("gmsh", of_gmsh, np.geomspace(16.0, 120.0, OF_GMSH)),
        ):
            count, found = fewest(make, name, equal, values)
            show(name, mesher, count, found / chord)


def show(name: str, mesher: str, count: int, share: float) -> None:
    """One line."""
    print(f"{name:8s} {mesher:22s} {count:7,d} triangles, {share:.3f} of the chord", flush=True)


def distance(name: str, mesh: Mesh) -> float:
    """The largest, at places of the triangles."""
    points, triangles = mesh
    largest = 0.0
    for first in range(0, len(triangles), AT_ONCE):
        some = points[triangles[first : first + AT_ONCE]]
        p = np.einsum("kc,ncd->nkd", PLACES, some).reshape(-1, 3)
        if name == "sphere":
            off = np.linalg.norm(p, axis=1) - 1.0
        else:
            off = np.hypot(np.hypot(p[:, 0], p[:, 1]) - 3.0, p[:, 2]) - 1.0
        largest = max(largest, float(np.abs(off).max()))
    return largest


def fewest(
    make: Callable[[str, float], Mesh], name: str, equal: float, values: NDArray[np.float64]
) -> tuple[int, float]:
    """Triangles and distance of the mesh with the fewest triangles that is as near as another."""
    best = (0, np.nan)
    for value in values.tolist():
        mesh = make(name, value)
        found, count = distance(name, mesh), len(mesh[1])
        if found <= equal and (not best[0] or count < best[0]):
            best = (count, found)
    return best


def of_ocp(name: str, deflection: float) -> Mesh:
    """By BRepMesh with a linear deflection, angles up to 1.5 radians."""
    fresh = SHAPES[name].val().copy()  # a shape keeps its finest mesh
    points, triangles = fresh.tessellate(deflection, 1.5)
    return np.array([point.toTuple() for point in points]), np.array(triangles)


def of_gmsh(name: str, on_a_turn: float) -> Mesh:
    """By gmsh with so many triangles on a turn of 2 pi."""
    import gmsh

    gmsh.initialize()
    gmsh.option.setNumber("General.Terminal", 0)
    gmsh.option.setNumber("Mesh.MeshSizeFromCurvature", on_a_turn)
    gmsh.option.setNumber("Mesh.MeshSizeExtendFromBoundary", 0)
    if name == "sphere":
        gmsh.model.occ.addSphere(0, 0, 0, 1)
    else:
        gmsh.model.occ.addTorus(0, 0, 0, 3, 1)
    gmsh.model.occ.synchronize()
    gmsh.model.mesh.generate(2)
    tags, coordinates, _ = gmsh.model.mesh.getNodes()
    row = np.zeros(int(tags.max()) + 1, int)
    row[tags.astype(int)] = np.arange(len(tags))
    triangles = row[gmsh.model.mesh.getElementsByType(2)[1].astype(int)].reshape(-1, 3)
    gmsh.finalize()
    return np.array(coordinates).reshape(-1, 3), triangles


if __name__ == "__main__":
    main()
