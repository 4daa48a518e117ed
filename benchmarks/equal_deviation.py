"""Triangles of other meshers for the same distance between mesh and model, both ways.

    python benchmarks/equal_deviation.py [FILES ...]

A sphere, a torus, a block with rounded edges and a hole, and CAD files are meshed for a chord of a
thousandth of the diagonal. Distances are measured without any code of ours: by VTK, from places of
all triangles to OpenCASCADE's triangles of the model for a 60th of the chord, and from places of
these to the mesh. The setting of each other mesher is then tried from coarse to fine until its mesh
is as near: the linear deflection of OpenCASCADE's BRepMesh, the triangles that gmsh puts on a turn,
mmgs's Hausdorff distance (from our mesh for a tenth of the chord). Distances do not fall steadily,
so counts depend on the values that are tried. A line for each: triangles, and distance / chord.
"""

import single_thread  # noqa: F401  (before numpy)

# isort: split
import argparse
import tempfile
from collections.abc import Callable
from pathlib import Path
from typing import NamedTuple

import cadquery as cq
import numpy as np
from numpy.typing import NDArray

import surfmesh as sm

FRACTION = 1_000
FINER = 60.0  # times the chord's: the triangles that stand for the model
ANGLE = 1.5  # radians: OpenCASCADE's angular deflection, which is to decide nothing
PLACES = np.array([(a, b, 4 - a - b) for a in range(5) for b in range(5 - a)]) / 4
FEW_PLACES = np.vstack((np.eye(3), np.full((1, 3), 1 / 3)))

Mesh = tuple[NDArray[np.float64], NDArray[np.integer]]


class Part(NamedTuple):
    """What is meshed, and the triangles that stand for it."""

    shape: cq.Shape
    model: sm.CadModel
    fine: Mesh

    @classmethod
    def of(cls, shape: cq.Shape) -> "Part":
        model = sm.from_cadquery(shape)
        return cls(shape, model, tessellated(shape, model.diagonal / FRACTION / FINER, 0.1))


def block() -> cq.Shape:
    """Rounded edges of two radii, which meet in spheres and tori, and a hole."""
    made = cq.Workplane().box(30, 20, 10).edges("|Z").fillet(4).faces(">Z").edges().fillet(1.5)
    return made.faces("<Z").workplane().hole(6).val()


SHAPES: dict[str, Callable[[], cq.Shape]] = {
    "sphere": lambda: cq.Workplane().sphere(1).val(),
    "torus": lambda: cq.Solid.makeTorus(3, 1),
    "block": block,
}


def main() -> None:
    parser = argparse.ArgumentParser(description=(__doc__ or "").partition("\n")[0])
    parser.add_argument("files", nargs="*", type=Path, help="STEP files")
    for path in parser.parse_args().files:
        SHAPES[path.stem[:24]] = lambda path=path: cq.importers.importStep(str(path)).val()
    for name, make in SHAPES.items():
        part = Part.of(make())
        chord = part.model.diagonal / FRACTION
        equal = of_surfmesh(name, part, chord)
        for mesher, tried, values in (
            ("OCP BRepMesh", of_ocp, np.geomspace(1.5, 0.05, 30) * chord),
            ("gmsh", of_gmsh, np.geomspace(20.0, 120.0, 19)),
            ("mmgs", of_mmgs, np.geomspace(1.5, 0.1, 15) * chord),
        ):
            count, found = first_as_near(tried, part, equal, values)
            show(name, mesher, count, found / chord)


def of_surfmesh(name: str, part: Part, chord: float) -> float:
    """The distance of our isotropic mesh; a line for it, a stretched and a balanced one."""
    found = {}
    for words, options in (
        ("surfmesh", {}),
        ("surfmesh, ratio 100", {"anisotropy": 100.0}),
        ("surfmesh, balanced", {"vertices": "balanced"}),
    ):
        mesh = sm.mesh(part.model, sm.Sizing(chord=chord, **options))
        found[words] = distance(part, (mesh.points, mesh.triangles))
        show(name, words, len(mesh.triangles), found[words] / chord)
    return found["surfmesh"]


def show(name: str, mesher: str, count: int, share: float) -> None:
    """One line."""
    print(f"{name:24s} {mesher:22s} {count:7,d} triangles, {share:.3f} of the chord", flush=True)


def distance(part: Part, mesh: Mesh) -> float:
    """The largest both ways, at places of the triangles."""
    return max(of_mesh(part, mesh), of_model(part, mesh))


def of_mesh(part: Part, mesh: Mesh) -> float:
    """From the model."""
    return farthest(mesh, part.fine, PLACES)


def of_model(part: Part, mesh: Mesh) -> float:
    """From the mesh; the triangles of the model are so small that few places do."""
    return farthest(part.fine, mesh, FEW_PLACES)


def farthest(mesh: Mesh, other: Mesh, places: NDArray[np.float64]) -> float:
    """The largest distance of places (q, 3) of ``mesh`` from ``other``, by VTK."""
    import pyvista
    from vtkmodules.util.numpy_support import numpy_to_vtk, vtk_to_numpy
    from vtkmodules.vtkCommonCore import vtkDoubleArray
    from vtkmodules.vtkFiltersCore import vtkImplicitPolyDataDistance

    points, triangles = mesh
    at = np.unique(np.einsum("kc,ncd->nkd", places, points[triangles]).reshape(-1, 3), axis=0)
    away = vtkImplicitPolyDataDistance()
    away.SetInput(pyvista.PolyData.from_regular_faces(*other))
    found = vtkDoubleArray()
    away.FunctionValue(numpy_to_vtk(np.ascontiguousarray(at)), found)
    return float(np.abs(vtk_to_numpy(found)).max())


def first_as_near(
    make: Callable[[Part, float], Mesh], part: Part, equal: float, values: NDArray[np.float64]
) -> tuple[int, float]:
    """Triangles and distance of the first mesh, from coarse to fine, that is as near; 0: none."""
    for value in values.tolist():
        mesh = make(part, value)
        found = of_mesh(part, mesh)
        if found <= equal and (back := of_model(part, mesh)) <= equal:
            return len(mesh[1]), max(found, back)
    return 0, np.nan


def tessellated(shape: cq.Shape, deflection: float, angle: float) -> Mesh:
    """By BRepMesh."""
    points, triangles = shape.copy().tessellate(deflection, angle)  # a shape keeps its finest mesh
    return np.array([point.toTuple() for point in points]), np.array(triangles)


def of_ocp(part: Part, deflection: float) -> Mesh:
    """By BRepMesh with a linear deflection."""
    return tessellated(part.shape, deflection, ANGLE)


def of_gmsh(part: Part, on_a_turn: float) -> Mesh:
    """By gmsh with so many triangles on a turn of 2 pi."""
    import gmsh

    gmsh.initialize()
    gmsh.option.setNumber("General.Terminal", 0)
    gmsh.option.setNumber("Mesh.MeshSizeFromCurvature", on_a_turn)
    gmsh.option.setNumber("Mesh.MeshSizeExtendFromBoundary", 0)
    with tempfile.TemporaryDirectory() as folder:
        path = str(Path(folder) / "part.brep")
        part.shape.exportBrep(path)
        gmsh.model.occ.importShapes(path)
    gmsh.model.occ.synchronize()
    gmsh.model.mesh.generate(2)
    tags, coordinates, _ = gmsh.model.mesh.getNodes()
    row = np.zeros(int(tags.max()) + 1, int)
    row[tags.astype(int)] = np.arange(len(tags))
    triangles = row[gmsh.model.mesh.getElementsByType(2)[1].astype(int)].reshape(-1, 3)
    gmsh.finalize()
    return np.array(coordinates).reshape(-1, 3), triangles


def of_mmgs(part: Part, hausdorff: float) -> Mesh:
    """By mmgs with a Hausdorff distance, from a fine mesh of ours."""
    from mmgpy import MmgMeshS

    fine = sm.mesh(part.model, chord=0.1 * part.model.diagonal / FRACTION)
    mesh = MmgMeshS(fine.points.copy(), fine.triangles.copy())
    mesh.remesh(hausd=hausdorff, hmax=part.model.diagonal, hgrad=-1.0, verbose=-1)
    return mesh.get_vertices(), mesh.get_triangles()


if __name__ == "__main__":
    main()
