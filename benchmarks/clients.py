"""What other programs make of our files: works, lost, seconds.

    python benchmarks/clients.py [--only NAME ...]

A part of two solids that share a face goes to each program that is installed; a program that is not
is a row with the reason. CalculiX solves a cantilever as a solid and as a shell, and is set beside
the theory of beams; capytaine, where it is installed, gives the added mass of a hemisphere in heave
against panels (0.831 of the displaced mass at frequency zero, 0.5 at infinity: Hulme, J. Fluid
Mech. 121, 1982). Debian: calculix-ccx, openfoam. pyNastran does not run with the newest numpy:
PYNASTRAN_PYTHON names the Python of an environment that has it.
"""

import argparse
import contextlib
import io
import os
import re
import shutil
import subprocess
import sys
import tempfile
import warnings
from collections.abc import Callable
from pathlib import Path
from time import process_time

import cadquery as cq
import numpy as np
from rich.box import SIMPLE_HEAD
from rich.markup import escape
from rich.table import Table
from tables import console

import surfmesh as sm
from surfmesh.io import FORMATS
from surfmesh.result.surface_mesh import SurfaceMesh

OPENFOAM = Path("/usr/share/openfoam")  # where Debian's package has its settings
LENGTH, SIDE, FORCE, YOUNG, POISSON = 100.0, 10.0, 100.0, 210000.0, 0.3  # mm, N, MPa
THIN_FORCE = 0.1  # on a strip of thickness 1
THIN_TIP = THIN_FORCE * LENGTH**3 / (3 * YOUNG * SIDE / 12)
MEDIT = {"file_format": "medit"}


def part() -> SurfaceMesh:
    """Two blocks that share a face, one with a hole; names on two faces."""
    from OCP.BOPAlgo import BOPAlgo_Builder

    fuse = BOPAlgo_Builder()
    fuse.AddArgument(cq.Workplane().box(4, 2, 2).faces(">Z").workplane().hole(1).val().wrapped)
    fuse.AddArgument(cq.Workplane().box(2, 2, 2).translate((3, 0, 0)).val().wrapped)
    fuse.Perform()
    return sm.mesh(cq.Shape.cast(fuse.Shape()), 0.5)


def gmsh_model(folder: Path) -> str:
    import gmsh

    mesh = part()
    mesh.to_gmsh()
    gmsh.model.mesh.generate(3)
    counts = [len(gmsh.model.mesh.getElements(3, tag)[1][0]) for tag in (1, 2)]
    groups = len(gmsh.model.getPhysicalGroups())
    gmsh.finalize()
    return f"to_gmsh, generate(3): {counts[0]} and {counts[1]} tetrahedra, {groups} physical groups"


def engine(name: str) -> Callable[[Path], str]:
    def fills(folder: Path) -> str:
        mesh = sm.mesh(cq.Workplane().box(4, 2, 2), 0.5) if name == "ftetwild" else part()
        found = mesh.tetrahedralize(name)
        kept = "surface kept" if not found.warnings else "new surface"
        return f"{len(found.elements)} tetrahedra, worst {found.shapes.min():.2f}, {kept}"

    return fills


def beam() -> tuple[SurfaceMesh, str, int]:
    """The cantilever, the name of its solid, the number of nodes at its tip."""
    shape = cq.Workplane().box(LENGTH, SIDE, SIDE, centered=(False, True, True))
    shape = shape.faces("<X").tag("fixed").end().faces(">X").tag("tip").end()
    mesh = sm.mesh(shape, 0.5 * SIDE, order=2)
    tip = mesh.face_ids == mesh.groups.face_names.index("tip")
    return mesh, mesh.groups.solid_label(0), len(np.unique(mesh.elements[tip]))


def solved(
    folder: Path, mesh_file: str, section: str, loads: str, ratio: float = POISSON
) -> float:  # fmt: skip
    """Mean displacement along z of the set of nodes ``tip``."""
    (folder / "run.inp").write_text(
        f"*INCLUDE, INPUT={mesh_file}\n*MATERIAL, NAME=STEEL\n*ELASTIC\n{YOUNG}, {ratio}\n"
        f"{section}*STEP\n*STATIC\n{loads}*NODE PRINT, NSET=tip\nU\n*END STEP\n"
    )
    subprocess.run(["ccx", "run"], cwd=folder, check=True, capture_output=True)
    rows = [line.split() for line in (folder / "run.dat").read_text().splitlines()]
    return float(np.mean([float(row[3]) for row in rows if len(row) == 4 and row[0].isdigit()]))


def calculix_solid(folder: Path) -> str:
    mesh, solid, loaded = beam()
    mesh.tetrahedralize().save(folder / "beam.inp")
    tip = solved(
        folder, "beam.inp",
        f"*SOLID SECTION, ELSET={solid}, MATERIAL=STEEL\n*BOUNDARY\nfixed, 1, 3\n",
        f"*CLOAD\ntip, 3, {FORCE / loaded}\n",
    )  # fmt: skip
    shear = FORCE * LENGTH / (5 / 6 * YOUNG / (2 + 2 * POISSON) * SIDE**2)
    theory = FORCE * LENGTH**3 / (3 * YOUNG * SIDE**4 / 12) + shear
    return f"C3D10: tip {tip:.4f} mm, theory of beams {theory:.4f}"


def calculix_shell(folder: Path) -> str:
    return f"S6: tip {shell_tip(folder, 2, 2.5, POISSON):.4f} mm, theory of beams {THIN_TIP:.4f}"


def calculix_straight_shells(folder: Path) -> str:
    """S3 is a wedge of linear functions to CalculiX. As its triangles shrink it tends to the theory
    where Poisson's ratio is 0, and else to about (1 - ratio^2) of it: its thickness changes by one
    figure, where bending thickens one side and thins the other."""
    rows = []
    for ratio in (POISSON, 0.0):
        tips = ", ".join(f"{shell_tip(folder, 1, size, ratio):.4f}" for size in (2.5, 1.25, 0.625))
        rows.append(f"ratio {ratio:g}: {tips}")
    return f"S3 of sizes 2.5, 1.25, 0.625: tip {'; '.join(rows)} mm, theory of beams {THIN_TIP:.4f}"


def shell_tip(folder: Path, order: int, size: float, ratio: float) -> float:
    """Displacement of the free end of a strip of thickness 1 under ``THIN_FORCE``, in mm."""
    strip = cq.Workplane().rect(LENGTH, SIDE).extrude(1.0).faces("<Z").val()
    mesh = sm.mesh(strip, size, order=order)
    mesh = mesh.replaced(groups=_with_ends(mesh))
    mesh.save(folder / "plate.inp", target="calculix")
    nodes = len(np.unique(mesh.edge_elements[np.isin(mesh.edge_ids, _edges(mesh, "tip"))]))
    face = mesh.groups.face_label(0).replace(" ", "_")
    section = f"*SHELL SECTION, ELSET={face}, MATERIAL=STEEL\n1.0\n*BOUNDARY\nfixed, 1, 6\n"
    return solved(folder, "plate.inp", section, f"*CLOAD\ntip, 3, {THIN_FORCE / nodes}\n", ratio)


def _edges(mesh: SurfaceMesh, name: str) -> list[int]:
    return [number for number, label in enumerate(mesh.groups.edge_names) if label == name]


def _with_ends(mesh: SurfaceMesh):
    """Groups whose edges at both ends along x are called ``fixed`` and ``tip``."""
    from dataclasses import replace

    names = []
    for edge in range(len(mesh.groups.edge_names)):
        x = mesh.points[mesh.edge_segments[mesh.edge_ids == edge], 0]
        at = "fixed" if (x < -0.49 * LENGTH).all() else "tip" if (x > 0.49 * LENGTH).all() else ""
        names.append(at)
    return replace(mesh.groups, edge_names=tuple(names))


def openfoam(folder: Path) -> str:
    shape = cq.Workplane().box(4, 2, 2).faces(">Z").tag("lid").end()
    sm.mesh(shape, 0.5).save(folder / "part.stl", solids="faces")
    told = subprocess.run(
        [_found("surfaceCheck"), "part.stl"], cwd=folder, capture_output=True, text=True,
        env=os.environ | ({"WM_PROJECT_DIR": str(OPENFOAM)} if OPENFOAM.is_dir() else {}),
    ).stdout  # fmt: skip
    regions = re.search(r"in (\d+) region", told)
    closed = "closed" if "Surface is closed" in told else "not closed"
    lost = "" if "lid" in told else ", lost: names"
    return f"surfaceCheck: {regions[1] if regions else 0} regions by name, {closed}{lost}"


def _found(command: str) -> str:
    path = shutil.which(command)
    if path is None:
        raise ImportError(f"{command} is not installed")
    return path


def meshio_all(folder: Path) -> str:
    import meshio

    mesh, lost = part(), []
    for extension in FORMATS:
        try:
            path = mesh.save(folder / f"part{extension}")
            with contextlib.redirect_stdout(io.StringIO()):
                found = meshio.read(path, **(MEDIT if extension == ".mesh" else {}))
            count = sum(len(block) for block in found.cells if block.type.startswith("triangle"))
            if count != len(mesh.triangles):
                lost.append(f"{extension} {count} of {len(mesh.triangles)} triangles")
        except (Exception, SystemExit):  # it ends the program for what it does not know
            lost.append(extension)
    return "all formats" if not lost else f"all but {', '.join(lost)}"


def trimesh_solid(folder: Path) -> str:
    mesh = sm.mesh(cq.Workplane().box(4, 2, 2), 0.5)
    found = mesh.to_trimesh()
    return f"to_trimesh: watertight {found.is_watertight}, volume {found.volume:.6g}"


def pyvista_grid(folder: Path) -> str:
    grid = part().tetrahedralize().to_pyvista()
    return f"to_pyvista: {grid.n_cells} tetrahedra, names {list(grid.field_data['solid_names'])}"


def pynastran(folder: Path) -> str:
    program = (
        "import sys; from pyNastran.bdf.bdf import read_bdf\n"
        "model = read_bdf(sys.argv[1], xref=True, debug=None)\n"
        "print(len(model.elements), 'elements,', len(model.properties), 'properties,', end='')"
    )
    path = part().save(folder / "part.bdf")
    python = os.environ.get("PYNASTRAN_PYTHON", sys.executable)
    read = subprocess.run([python, "-c", program, str(path)], capture_output=True, text=True)
    if read.returncode:
        reason = read.stderr.strip().splitlines()[-1]
        raise ImportError(reason) if "numpy" in reason or "No module" in reason else OSError(reason)
    return f"{read.stdout.splitlines()[-1]} cross-referenced"


def lib3mf(folder: Path) -> str:
    from lib3mf import get_wrapper

    path = sm.mesh(cq.Workplane().box(4, 2, 2), 0.5).save(folder / "part.3mf")
    reader = get_wrapper().CreateModel().QueryReader("3mf")
    reader.ReadFromFile(str(path))
    return f"read with {reader.GetWarningCount()} warnings"


def mmg(folder: Path) -> str:
    import mmgpy

    path = sm.mesh(cq.Workplane().box(4, 2, 2), 0.5).save(folder / "part.mesh")
    found = mmgpy.read(path)
    return f".mesh: {len(found.get_triangles())} triangles"


def manifold(folder: Path) -> str:
    import manifold3d

    mesh = sm.mesh(cq.Workplane().box(4, 2, 2), 0.5)
    arrays = manifold3d.Mesh(mesh.points.astype(np.float32), mesh.triangles.astype(np.uint32))
    found = manifold3d.Manifold(arrays)
    return f"{found.status().name}, volume {found.volume():.6g}"


def capytaine(folder: Path) -> str:
    import capytaine as cpt

    told = []
    for count, vertices in ((200, "on_surface"), (800, "on_surface"), (800, "balanced")):
        ball = sm.ParametricSurface(
            "cos(v)*cos(u)", "cos(v)*sin(u)", "sin(v)", u=(0, "2*pi"), v=("-pi/2", 0)
        )
        mesh = sm.mesh(ball, triangles=count, vertices=vertices)
        quads = np.column_stack((mesh.triangles, mesh.triangles[:, 2]))
        body = cpt.FloatingBody(cpt.Mesh(mesh.points, quads), name="hemisphere")
        body.add_translation_dof(name="Heave")
        mass = 2.0 / 3.0 * np.pi * 1000.0
        solver, at = cpt.BEMSolver(method="direct"), []  # the indirect one is off by 2 % at 800
        for omega in (0.0, np.inf):
            problem = cpt.RadiationProblem(body=body, omega=omega, radiating_dof="Heave")
            at.append(solver.solve(problem).added_masses["Heave"] / mass)
        panels = "balanced panels" if vertices == "balanced" else "panels"
        told.append(f"{len(mesh.triangles)} {panels} {at[0]:.4f} / {at[1]:.4f}")
    return f"added mass at 0 / infinity: {', '.join(told)} (0.8310 / 0.5)"


def pins_in_a_plate() -> tuple[cq.Assembly, set[frozenset[str]]]:
    """Nine pins in the holes of a plate, on a base; and which of them touch."""
    places = [(x, y) for x in (-3, 0, 3) for y in (-3, 0, 3)]
    plate = cq.Workplane().rect(10, 10).extrude(1).faces(">Z").workplane()
    found = cq.Assembly().add(plate.pushPoints(places).hole(1.0), name="plate")
    found.add(cq.Workplane().rect(10, 10).extrude(-1), name="base")
    touching = {frozenset(("plate", "base"))}
    for number, place in enumerate(places):
        pin = cq.Workplane().center(*place).circle(0.5).extrude(1.5)
        found.add(pin, name=f"pin {number}")
        touching |= {frozenset((f"pin {number}", other)) for other in ("plate", "base")}
    return found, touching


def nested_shells() -> tuple[cq.Assembly, set[frozenset[str]]]:
    """A ball within two shells."""
    ball, middle, outer = (cq.Workplane().sphere(radius) for radius in (1, 2, 3))
    found = cq.Assembly().add(ball, name="ball").add(middle.cut(ball), name="middle")
    found.add(outer.cut(middle), name="outer")
    return found, {frozenset(("ball", "middle")), frozenset(("middle", "outer"))}


def imprint(folder: Path) -> str:
    """Names that are kept, pairs of bodies with one common mesh, and tetrahedra on both sides."""
    told = []
    for make in (pins_in_a_plate, nested_shells):
        assembly, touching = make()
        mesh = sm.mesh(sm.from_cadquery(assembly, imprint=True), 0.5)
        names = [child.name for child in assembly.children]
        kept = sum(name in mesh.groups.solid_names for name in names)
        common = mesh.solid_ids[(mesh.solid_ids >= 0).all(axis=1)]
        pairs = {frozenset(mesh.groups.solid_names[i] for i in pair) for pair in common.tolist()}
        filled = mesh.tetrahedralize()
        clean = "clean" if mesh.report.clean else "NOT CLEAN"
        told.append(
            f"{make.__name__.replace('_', ' ')}: {kept} of {len(names)} names, "
            f"{len(pairs & touching)} of {len(touching)} pairs conformal, "
            f"{len(pairs - touching)} others, {clean}, "
            f"{len(np.unique(filled.solid_ids))} solids filled"
        )
    return "; ".join(told)


CLIENTS: dict[str, Callable[[Path], str]] = {
    "gmsh": gmsh_model,
    "tetgen": engine("tetgen"),
    "gmsh (fills)": engine("gmsh"),
    "netgen": engine("netgen"),
    "ftetwild": engine("ftetwild"),
    "imprint": imprint,
    "CalculiX solid": calculix_solid,
    "CalculiX shell": calculix_straight_shells,
    "CalculiX shell, order 2": calculix_shell,
    "OpenFOAM": openfoam,
    "meshio": meshio_all,
    "trimesh": trimesh_solid,
    "PyVista": pyvista_grid,
    "pyNastran": pynastran,
    "lib3mf": lib3mf,
    "mmg": mmg,
    "manifold3d": manifold,
    "capytaine": capytaine,
}


def main() -> None:
    parser = argparse.ArgumentParser(description=(__doc__ or "").partition("\n")[0])
    parser.add_argument("--only", nargs="+", default=list(CLIENTS), metavar="NAME")
    options = parser.parse_args()
    table = Table("program", "what came of it", "seconds", box=SIMPLE_HEAD)
    for name in options.only:
        start = process_time()
        with tempfile.TemporaryDirectory() as folder, warnings.catch_warnings():
            warnings.simplefilter("ignore")
            try:
                told = CLIENTS[name](Path(folder))
            except (ImportError, OSError) as error:
                told = f"not here: {error}"
            except Exception as error:
                told = f"FAILED: {type(error).__name__}: {error}"
        table.add_row(name, escape(told), f"{process_time() - start:.1f}")
    console.print(table)


if __name__ == "__main__":
    main()
