"""Surfaces that meet: curves against closed forms, branches, volumes, quality, seconds.

    python benchmarks/meeting.py                    all of it, with planes at 200 heights
    python benchmarks/meeting.py --heights 20       fewer heights
    python benchmarks/meeting.py curves solids      some parts: curves waves solids quality peers

Seconds are of the processor, of ``intersect`` and of the mesh. gmsh is asked for the same parts by
its OpenCASCADE kernel: its fragments or unions, and a mesh of the same edge length.
"""

import single_thread  # noqa: F401  (before numpy)

# isort: split
import argparse
import time
from collections.abc import Callable, Iterator
from math import pi

import numpy as np

import surfmesh as sm
from surfmesh.errors import SurfmeshError

TURN = (0, "2*pi")
SAMPLES = np.linspace(0.0, 1.0, 401)
SKEW = 0.6  # radians


def tube(axis: str, radius: float, half: float, name: str) -> sm.ParametricSurface:
    around = [f"{radius}*cos(u)", f"{radius}*sin(u)"]
    around.insert("xyz".index(axis), "v")
    return sm.ParametricSurface(*around, u=TURN, v=(-half, half), name=name)


def skew_tube(radius: float, half: float, name: str) -> sm.ParametricSurface:
    """Its axis is at the angle SKEW to that of x, at y = 0.2."""
    c, s = np.cos(SKEW), np.sin(SKEW)
    return sm.ParametricSurface(
        f"v*{c} - {radius}*sin(u)*{s}", f"{radius}*cos(u) + 0.2", f"v*{s} + {radius}*sin(u)*{c}",
        u=TURN, v=(-half, half), name=name,
    )  # fmt: skip


def sphere(x: float, y: float, z: float, name: str) -> sm.ParametricSurface:
    return sm.ParametricSurface(
        f"{x} + cos(u)*cos(v)", f"{y} + sin(u)*cos(v)", f"{z} + sin(v)",
        u=TURN, v=("-pi/2", "pi/2"), name=name,
    )  # fmt: skip


def plane(x: str, y: str, z: str, half: float, name: str = "plane") -> sm.ParametricSurface:
    return sm.ParametricSurface(x, y, z, u=(-half, 1.01 * half), v=(-half, half), name=name)


def off_skew_tube(p: np.ndarray) -> np.ndarray:
    """Distances (n,) of points (n, 3) from ``skew_tube(0.7, ...)``."""
    c, s = np.cos(SKEW), np.sin(SKEW)
    return np.hypot(p[:, 1] - 0.2, -p[:, 0] * s + p[:, 2] * c) - 0.7


def off_tube(axis: int, radius: float) -> Callable[[np.ndarray], np.ndarray]:
    return lambda p: np.linalg.norm(np.delete(p, axis, axis=1), axis=1) - radius


def off_sphere(*centre: float) -> Callable[[np.ndarray], np.ndarray]:
    return lambda p: np.linalg.norm(p - centre, axis=1) - 1.0


def off_torus(p: np.ndarray) -> np.ndarray:
    return np.hypot(np.hypot(p[:, 0], p[:, 1]) - 3.0, p[:, 2]) - 1.0


def curve_cases() -> Iterator[tuple[str, list, list, int | None]]:
    """Name, surfaces, distances in closed form, points where curves cross on two surfaces."""
    wide = tube("z", 1.0, 3.0, "wide")
    yield "tubes at right angles", [wide, tube("x", 0.7, 3.0, "thin")], [
        off_tube(2, 1.0), off_tube(0, 0.7)], 0  # fmt: skip
    yield "skew tubes", [wide, skew_tube(0.7, 4.0, "thin")], [off_tube(2, 1.0), off_skew_tube], 0
    yield "equal tubes", [wide, tube("x", 1.0, 3.0, "equal")], [
        off_tube(2, 1.0), off_tube(0, 1.0)], 2  # fmt: skip
    yield "two spheres", [sphere(0, 0, 0, "a"), sphere(1, 0.1, 0.2, "b")], [
        off_sphere(0, 0, 0), off_sphere(1, 0.1, 0.2)], 0  # fmt: skip
    slope = np.tan(np.arcsin(1.0 / 3.0))
    yield "torus, plane of Villarceau", [
        sm.load("torus"), plane("u", "v", f"{slope}*u", 5.0)
    ], [off_torus, lambda p: (p[:, 2] - slope * p[:, 0]) / np.hypot(1.0, slope)], 2  # fmt: skip
    yield "torus, plane along its top", [sm.load("torus"), plane("u", "v", "1", 5.0)], [], None


def curves() -> None:
    print(f"\n{'curves':30} {'edges':>6} {'length':>9} {'off / diagonal':>15} {'crossings':>10}"
          f" {'seconds':>8}")  # fmt: skip
    for name, surfaces, distances, wanted in curve_cases():
        start = time.process_time()
        try:
            model = sm.intersect(surfaces)
        except SurfmeshError as error:
            print(f"{name:30} refused: {error}")
            continue
        seconds = time.process_time() - start
        edges = [edge for edge in model.edges if "/" in edge.name]
        points = np.concatenate([edge.evaluate(SAMPLES)[0] for edge in edges])
        off = max(np.abs(distance(points)).max() for distance in distances) / model.diagonal
        uses = np.bincount([vertex for e in edges for vertex in (e.start, e.end)])
        crossing = int((uses == 4).sum())
        mark = "" if crossing == wanted else f"  WANTED {wanted}"
        print(f"{name:30} {len(edges):6} {sum(e.length for e in edges):9.5f} {off:15.2e}"
              f" {crossing:10}{mark} {seconds:8.2f}")  # fmt: skip


def waves(heights: int) -> None:
    """Branches on the wavy surface at many heights against a contour on 2001 x 2001 points."""
    import contourpy

    line = np.linspace(-5.0, 5.0, 2001)
    z = 100.0 * np.sin(line)[None, :] * np.cos(line)[:, None]
    contour = contourpy.contour_generator(line, line, z)
    wavy, wrong, branches, off = sm.load("wavy"), [], 0, 0.0
    start = time.process_time()
    for height in np.linspace(-99.5, 99.5, heights):
        lines = contour.lines(height)
        wanted = len(lines), sum(np.array_equal(one[0], one[-1]) for one in lines)
        try:
            model = sm.intersect([wavy, plane("u", "v", repr(float(height)), 181.0)])
        except SurfmeshError as error:
            wrong.append(f"{height:.4g}: {error}")
            continue
        edges = [edge for edge in model.edges if "/" in edge.name]
        found = len(edges), sum(edge.closed for edge in edges)
        branches += len(edges)
        for edge in edges:
            off = max(off, np.abs(edge.evaluate(SAMPLES)[0][:, 2] - height).max())
        if found != wanted:
            wrong.append(f"{height:.4g}: {found} branches, closed ones, where there are {wanted}")
    seconds = time.process_time() - start
    print(f"\nwavy, planes at {heights} heights: {branches} branches, {len(wrong)} heights wrong, "
          f"off by {off / 470:.1e} of the diagonal, {seconds:.1f} s")  # fmt: skip
    print("\n".join(wrong))


def lens(distance: float) -> float:
    h = 1.0 - distance / 2.0
    return 2.0 * pi * h * h * (3.0 - h) / 3.0


def solid_cases() -> Iterator[tuple[str, list, str, float]]:
    """Name, inputs, what is kept, the volume in closed form; of the wing and the fuselage that
    of both, less the common part as it is found."""
    import cadquery as cq

    balls, ball = [sphere(0, 0, 0, "a"), sphere(1, 0.1, 0.2, "b")], 4.0 * pi / 3.0
    common = lens(np.sqrt(1.05))
    yield "two spheres", balls, "union", 2.0 * ball - common
    yield "two spheres", balls, "common", common
    yield "two spheres", balls, "difference", ball - common
    rods = [cq.Workplane().cylinder(6, 1), cq.Workplane("YZ").cylinder(6, 1)]
    yield "two equal rods", rods, "union", 12.0 * pi - 16.0 / 3.0
    box, bar = cq.Workplane().box(2, 2, 2), cq.Workplane().cylinder(3, 0.5).translate((0.1, 0, 0))
    yield "a drilled box", [box, bar], "difference", 8.0 - pi / 2.0
    parts = [sm.ParametricSurface(**_table(name)) for name in ("fuselage", "wing")]
    both = 4.0 * pi / 3.0 * (3.0 * 0.5 * 0.5 + 0.55 * 0.07 * 2.2)  # their own volumes
    yield "wing and fuselage", parts, "union", both - sm.intersect(parts, keep="common").volume


def _table(name: str) -> dict:
    """A surface of the ready-made wing and fuselage."""
    import tomllib

    from surfmesh.intersection.meeting_file import meeting_gallery

    table = tomllib.loads(meeting_gallery()["wing_and_fuselage"].read_text())[name]
    domain = table.pop("domain")
    return table | {"u": domain["u"], "v": domain["v"], "name": name}


def solids() -> None:
    print(f"\n{'solids':20} {'keep':11} {'volume':>10} {'error':>9} {'triangles':>9} {'clean':>6}"
          f" {'mesh volume':>11} {'chord allows':>12} {'intersect':>9} {'mesh':>6}")  # fmt: skip
    for name, inputs, keep, volume in solid_cases():
        start = time.process_time()
        model = sm.intersect(inputs, keep=keep)
        middle = time.process_time()
        chord = 1e-3 * model.diagonal
        mesh = sm.mesh(model, sm.Sizing(chord=chord))
        end = time.process_time()
        report = sm.check(mesh)
        print(f"{name:20} {keep:11} {model.volume:10.6f} {model.volume / volume - 1.0:9.1e}"
              f" {len(mesh.triangles):9,} {report.clean!s:>6} {report.volume / volume - 1.0:11.1e}"
              f" {chord * model.area / volume:12.1e} {middle - start:9.2f} {end - middle:6.2f}"
              )  # fmt: skip


def quality() -> None:
    """Alpha of triangles with an edge on a common curve, and of all others."""
    from surfmesh.accuracy.shape import mean_ratio

    print(f"\n{'quality along curves':24} {'along':>6} {'mean':>6} {'1 %':>6} {'others':>7}"
          f" {'mean':>6} {'1 %':>6} {'clean':>6}")  # fmt: skip
    for name in ("crossing_pipes", "wing_and_fuselage", "wavy_cut", "three_sheets"):
        model = sm.load(name)
        size = model.diagonal
        mesh = sm.mesh(model, sm.Sizing(chord=1e-3 * size, max_size=0.03 * size))
        common = np.array(["/" in edge.name for edge in model.edges])
        on_curve = np.zeros(len(mesh.points), bool)
        on_curve[mesh.edge_segments[common[mesh.edge_ids]].ravel()] = True
        along = on_curve[mesh.triangles].sum(axis=1) >= 2
        a, b, c = np.moveaxis(mesh.points[mesh.triangles], 1, 0)
        alpha = mean_ratio(b - a, c - a)
        cells = []
        for rows in (along, ~along):
            low = np.percentile(alpha[rows], 1.0)
            cells.append(f"{rows.sum():6,} {alpha[rows].mean():6.3f} {low:6.3f}")
        print(f"{name:24} {cells[0]} {cells[1]:>22} {sm.check(mesh).clean!s:>6}")


def peers() -> None:
    """Unions of CAD bodies: seconds, triangles and volumes, here and by gmsh."""
    import cadquery as cq
    import gmsh

    cases = {
        "pipes": (("cylinder", (0, 0, -3, 0, 0, 6, 1)), ("cylinder", (-3, 0, 0, 6, 0, 0, 0.7))),
        "equal rods": (("cylinder", (0, 0, -3, 0, 0, 6, 1)), ("cylinder", (-3, 0, 0, 6, 0, 0, 1))),
        "box and ball": (("box", (-1, -1, -1, 2, 2, 2)), ("sphere", (0.01, 0.02, 0.03, 1.2))),
    }
    here = {
        "pipes": [cq.Workplane().cylinder(6, 1), cq.Workplane("YZ").cylinder(6, 0.7)],
        "equal rods": [cq.Workplane().cylinder(6, 1), cq.Workplane("YZ").cylinder(6, 1)],
        "box and ball": [
            cq.Workplane().box(2, 2, 2), cq.Workplane().sphere(1.2).translate((0.01, 0.02, 0.03))
        ],
    }  # fmt: skip
    size = 0.15
    print(f"\n{'unions, edge length 0.15':24} {'by':9} {'seconds':>8} {'triangles':>9}"
          f" {'volume':>10}")  # fmt: skip
    for name, bodies in cases.items():
        start = time.process_time()
        model = sm.intersect(here[name], keep="union")
        mesh = sm.mesh(model, size)
        seconds = time.process_time() - start
        print(f"{name:24} surfmesh  {seconds:8.2f} {len(mesh.triangles):9,} {model.volume:10.6f}")
        start = time.process_time()
        try:
            triangles, volume = by_gmsh(gmsh, bodies, size)
        except Exception as error:  # gmsh has no others
            print(f"{'':24} gmsh      failed: {error}")
            gmsh.finalize()
            continue
        seconds = time.process_time() - start
        print(f"{'':24} gmsh      {seconds:8.2f} {triangles:9,} {volume:10.6f}")


def by_gmsh(gmsh, bodies: tuple, size: float) -> tuple[int, float]:
    gmsh.initialize()
    gmsh.option.setNumber("General.Verbosity", 0)
    gmsh.option.setNumber("General.NumThreads", 1)
    add = {
        "cylinder": gmsh.model.occ.addCylinder, "box": gmsh.model.occ.addBox,
        "sphere": gmsh.model.occ.addSphere,
    }  # fmt: skip
    made = [(3, add[kind](*numbers)) for kind, numbers in bodies]
    united, _ = gmsh.model.occ.fuse(made[:1], made[1:])
    gmsh.model.occ.synchronize()
    volume = sum(gmsh.model.occ.getMass(3, tag) for _, tag in united)
    gmsh.option.setNumber("Mesh.MeshSizeMax", size)
    gmsh.option.setNumber("Mesh.MeshSizeMin", size)
    gmsh.model.mesh.generate(2)
    types, tags, _ = gmsh.model.mesh.getElements(2)
    triangles = sum(len(own) for kind, own in zip(types, tags) if kind == 2)
    gmsh.finalize()
    return triangles, volume


PARTS = {"curves": curves, "solids": solids, "quality": quality, "peers": peers}


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("parts", nargs="*", default=[], help="curves waves solids quality peers")
    parser.add_argument("--heights", type=int, default=200)
    options = parser.parse_args()
    for part in options.parts or [*PARTS, "waves"]:
        if part == "waves":
            waves(options.heights)
        else:
            PARTS[part]()


if __name__ == "__main__":
    main()
