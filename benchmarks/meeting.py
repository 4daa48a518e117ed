"""Surfaces that meet: curves against closed forms, branches, volumes, quality, seconds.

    python benchmarks/meeting.py                    all of it, with planes at 200 heights
    python benchmarks/meeting.py --heights 20       fewer heights
    python benchmarks/meeting.py curves solids      some parts: curves waves solids quality peers

Seconds are of the processor, of ``intersect`` and of the mesh. gmsh is asked for the same parts by
its OpenCASCADE kernel: its unions, and a mesh of the same edge length; manifold3d for the union of
finished meshes, where it is installed. Each line is printed as soon as it is measured.
"""

import single_thread  # noqa: F401  (before numpy)

# isort: split
import argparse
import time
from collections.abc import Callable, Iterator
from functools import partial
from math import pi
from typing import Any, NamedTuple

import numpy as np

import surfmesh as sm
from surfmesh.errors import SurfmeshError

TURN = (0, "2*pi")
SAMPLES = np.linspace(0.0, 1.0, 401)
SKEW = 0.6  # radians
SIZE = 0.15  # edge length of meshes that are compared with those of others

Distance = Callable[[np.ndarray], np.ndarray]
"""Points (n, 3) -> signed distances (n,) from a surface."""


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


def off_tube(axis: int, radius: float) -> Distance:
    return lambda p: np.linalg.norm(np.delete(p, axis, axis=1), axis=1) - radius


def off_sphere(*centre: float) -> Distance:
    return lambda p: np.linalg.norm(p - centre, axis=1) - 1.0


def off_torus(p: np.ndarray) -> np.ndarray:
    return np.hypot(np.hypot(p[:, 0], p[:, 1]) - 3.0, p[:, 2]) - 1.0


def to_first_order(f: Distance) -> Distance:
    """The distance from f = 0: f by its slope, which differences tell."""

    def distance(p: np.ndarray) -> np.ndarray:
        step = 1e-6 * np.eye(3)
        slope = np.stack([(f(p + h) - f(p - h)) / 2e-6 for h in step], axis=1)
        return f(p) / np.linalg.norm(slope, axis=1)

    return distance


@to_first_order
def off_fuselage(p: np.ndarray) -> np.ndarray:
    return (p[:, 0] / 3.0) ** 2 + (p[:, 1] / 0.5) ** 2 + (p[:, 2] / 0.5) ** 2 - 1.0


@to_first_order
def off_wing(p: np.ndarray) -> np.ndarray:
    y = p[:, 1] / 2.2
    x, z = (p[:, 0] - 0.5 * y**2) / 0.55, (p[:, 2] + 0.05 - 0.03 * y**2) / 0.07
    return x**2 + y**2 + z**2 - 1.0


OFF_SHEETS = {
    "floor": lambda p: p[:, 2] - 0.3 * p[:, 0] * p[:, 1],
    "wall": lambda p: p[:, 1] - 0.2 * np.sin(3.0 * p[:, 0]),
    "screen": lambda p: p[:, 0] - 0.1 - 0.2 * p[:, 2] * p[:, 1],
}
"""No less than the distances: their slopes are 1 at least."""


class CurveCase(NamedTuple):
    """distances: from each surface by its name. crossings: points where curves cross on two
    surfaces."""

    name: str
    surfaces: list
    distances: dict[str, Distance]
    crossings: int


def curve_cases() -> Iterator[CurveCase]:
    wide = tube("z", 1.0, 3.0, "wide")
    off = {"wide": off_tube(2, 1.0)}
    yield CurveCase(
        "tubes at right angles", [wide, tube("x", 0.7, 3.0, "thin")],
        off | {"thin": off_tube(0, 0.7)}, 0,
    )  # fmt: skip
    yield CurveCase("skew tubes", [wide, skew_tube(0.7, 4.0, "thin")],
                    off | {"thin": off_skew_tube}, 0)  # fmt: skip
    yield CurveCase("equal tubes", [wide, tube("x", 1.0, 3.0, "equal")],
                    off | {"equal": off_tube(0, 1.0)}, 2)  # fmt: skip
    yield CurveCase("two spheres", [sphere(0, 0, 0, "a"), sphere(1, 0.1, 0.2, "b")],
                    {"a": off_sphere(0, 0, 0), "b": off_sphere(1, 0.1, 0.2)}, 0)  # fmt: skip
    slope = np.tan(np.arcsin(1.0 / 3.0))
    yield CurveCase(
        "torus, plane of Villarceau", [sm.load("torus"), plane("u", "v", f"{slope}*u", 5.0)],
        {"torus": off_torus, "plane": lambda p: (p[:, 2] - slope * p[:, 0]) / np.hypot(1.0, slope)},
        2,
    )  # fmt: skip
    yield CurveCase(
        "torus, plane of symmetry", [sm.load("torus"), plane("u", "v", "0", 5.0)],
        {"torus": off_torus, "plane": lambda p: p[:, 2]}, 0,
    )  # fmt: skip
    yield CurveCase(
        "torus, plane along its top", [sm.load("torus"), plane("u", "v", "1", 5.0)],
        {"torus": off_torus, "plane": lambda p: p[:, 2] - 1.0}, 0,
    )  # fmt: skip
    yield CurveCase("three sheets", sheets("three_sheets"), OFF_SHEETS, 0)
    yield CurveCase(
        "wing and fuselage", sheets("wing_and_fuselage"),
        {"fuselage": off_fuselage, "wing": off_wing}, 0,
    )  # fmt: skip


def sheets(name: str) -> list[sm.ParametricSurface]:
    """The surfaces of a ready-made example."""
    import tomllib

    from surfmesh.intersection.meeting_file import meeting_gallery

    content = tomllib.loads(meeting_gallery()[name].read_text())
    made = []
    for own in content["intersect"]:
        table = content[own]
        domain = table.pop("domain")
        made.append(sm.ParametricSurface(**table, u=domain["u"], v=domain["v"], name=own))
    return made


def say(*words: object) -> None:
    print(*words, flush=True)


def curves() -> None:
    say(f"\n{'curves':30} {'edges':>6} {'length':>9} {'off / diagonal':>15} {'crossings':>10}"
        f" {'seconds':>8}")  # fmt: skip
    for name, surfaces, distances, wanted in curve_cases():
        start = time.process_time()
        try:
            model = sm.intersect(surfaces)
        except SurfmeshError as error:
            say(f"{name:30} refused: {error}")
            continue
        seconds = time.process_time() - start
        edges = [edge for edge in model.edges if "/" in edge.name]
        off = 0.0
        for edge in edges:
            points = edge.evaluate(SAMPLES)[0]
            for own in edge.name.split("/"):
                off = max(off, np.abs(distances[own](points)).max() / model.diagonal)
        uses = np.bincount([vertex for e in edges for vertex in (e.start, e.end)], minlength=1)
        # three sheets have six ends in their common point
        crossing = int((uses == 4).sum())
        mark = "" if crossing == wanted else f"  WANTED {wanted}"
        say(f"{name:30} {len(edges):6} {sum(e.length for e in edges):9.5f} {off:15.2e}"
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
    say(f"\nwavy, planes at {heights} heights: {branches} branches, {len(wrong)} heights wrong, "
        f"off by {off / 470:.1e} of the diagonal, {seconds:.1f} s")  # fmt: skip
    say("\n".join(wrong))


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
    parts = sheets("wing_and_fuselage")
    both = 4.0 * pi / 3.0 * (3.0 * 0.5 * 0.5 + 0.55 * 0.07 * 2.2)  # their own volumes
    yield "wing and fuselage", parts, "union", both - sm.intersect(parts, keep="common").volume


def solids() -> None:
    say(f"\n{'solids':20} {'keep':11} {'volume':>10} {'error':>9} {'triangles':>9} {'clean':>6}"
          f" {'mesh volume':>11} {'chord allows':>12} {'intersect':>9} {'mesh':>6}")  # fmt: skip
    for name, inputs, keep, volume in solid_cases():
        start = time.process_time()
        model = sm.intersect(inputs, keep=keep)
        middle = time.process_time()
        chord = 1e-3 * model.diagonal
        mesh = sm.mesh(model, sm.Sizing(chord=chord))
        end = time.process_time()
        report = sm.check(mesh)
        say(f"{name:20} {keep:11} {model.volume:10.6f} {model.volume / volume - 1.0:9.1e}"
              f" {len(mesh.triangles):9,} {report.clean!s:>6} {report.volume / volume - 1.0:11.1e}"
              f" {chord * model.area / volume:12.1e} {middle - start:9.2f} {end - middle:6.2f}"
              )  # fmt: skip


def quality() -> None:
    """Alpha of triangles with an edge on a common curve, and of all others."""
    say(f"\n{'quality along curves':20} {'size':>5} {'along':>6} {'mean':>6} {'1 %':>6}"
        f" {'others':>7} {'mean':>6} {'1 %':>6} {'mean +-':>8} {'1 % +-':>7} {'clean':>6}"
        )  # fmt: skip
    for name in ("crossing_pipes", "wing_and_fuselage", "wavy_cut", "three_sheets"):
        for part in (0.03, 0.015):
            model = sm.load(name)
            chord = 1e-3 * (part / 0.03) ** 2
            sizing = sm.Sizing(chord=chord * model.diagonal, max_size=part * model.diagonal)
            mesh = sm.mesh(model, sizing)
            along = beside_curves(mesh, model)
            alpha = shape(mesh.points, mesh.triangles)
            own, other = alpha[along], alpha[~along]
            means = own.mean(), other.mean()
            low = np.percentile(own, 1.0), np.percentile(other, 1.0)
            say(f"{name:20} {part:5} {len(own):6,} {means[0]:6.3f} {low[0]:6.3f}"
                f" {len(other):7,} {means[1]:6.3f} {low[1]:6.3f} {means[0] - means[1]:+8.3f}"
                f" {low[0] - low[1]:+7.3f}"
                f" {sm.check(mesh).clean!s:>6}")  # fmt: skip


def beside_curves(mesh: sm.SurfaceMesh, model: sm.CadModel) -> np.ndarray:
    """(n,) bool: triangles with an edge on a common curve."""
    common = np.array(["/" in edge.name for edge in model.edges])
    on_curve = np.zeros(len(mesh.points), bool)
    on_curve[mesh.edge_segments[common[mesh.edge_ids]].ravel()] = True
    return on_curve[mesh.triangles].sum(axis=1) >= 2


def shape(points: np.ndarray, triangles: np.ndarray) -> np.ndarray:
    """Alpha (n,)."""
    from surfmesh.accuracy.shape import mean_ratio

    a, b, c = np.moveaxis(points[triangles], 1, 0)
    return mean_ratio(b - a, c - a)


class Peer(NamedTuple):
    """What one mesher made of a union."""

    points: np.ndarray
    triangles: np.ndarray
    volume: float


def ellipsoid(a: float, b: float, c: float, name: str) -> sm.ParametricSurface:
    return sm.ParametricSurface(
        f"{a}*cos(u)*cos(v)", f"{b}*sin(v)", f"{c}*sin(u)*cos(v)",
        u=TURN, v=("-pi/2", "pi/2"), name=name,
    )  # fmt: skip


def peer_cases() -> Iterator[tuple[str, list, tuple]]:
    """Name, bodies here, and by gmsh: a kind, its numbers, and along which axes it is stretched."""
    import cadquery as cq

    rod, bar = cq.Workplane().cylinder(6, 1), ("cylinder", (0, 0, -3, 0, 0, 6, 1), ())
    yield "pipes", [rod, cq.Workplane("YZ").cylinder(6, 0.7)], (
        bar, ("cylinder", (-3, 0, 0, 6, 0, 0, 0.7), ()))  # fmt: skip
    yield "equal rods", [rod, cq.Workplane("YZ").cylinder(6, 1)], (
        bar, ("cylinder", (-3, 0, 0, 6, 0, 0, 1), ()))  # fmt: skip
    ball = cq.Workplane().sphere(1.2).translate((0.01, 0.02, 0.03))
    yield "box and ball", [cq.Workplane().box(2, 2, 2), ball], (
        ("box", (-1, -1, -1, 2, 2, 2), ()), ("sphere", (0.01, 0.02, 0.03, 1.2), ()))  # fmt: skip
    wing, body = (0.55, 2.2, 0.07), (3.0, 0.5, 0.5)
    yield "straight wing, fuselage", [ellipsoid(*body, "fuselage"), ellipsoid(*wing, "wing")], (
        ("sphere", (0, 0, 0, 1), body), ("sphere", (0, 0, 0, 1), wing))  # fmt: skip


def peers() -> None:
    """Unions: seconds, triangles, volumes and shape, here, by gmsh and of finished meshes."""
    say(f"\n{f'unions, edge length {SIZE}':26} {'by':10} {'seconds':>8} {'triangles':>9}"
        f" {'volume':>10} {'alpha':>6} {'1 %':>6} {'least':>6}")  # fmt: skip
    for name, bodies, by_kind in peer_cases():
        compared(name, "surfmesh", partial(by_surfmesh, bodies))
        compared("", "gmsh", partial(by_gmsh, by_kind))
        compared("", "manifold3d", partial(by_manifold, bodies))


def compared(name: str, by: str, make: Callable[[], Peer]) -> None:
    start = time.process_time()
    try:
        made = make()
    except Exception as error:  # gmsh has no others; what is not installed
        say(f"{name:26} {by:10} failed: {error}")
        return
    seconds = time.process_time() - start
    alpha = shape(made.points, made.triangles)
    say(f"{name:26} {by:10} {seconds:8.2f} {len(alpha):9,} {made.volume:10.6f} {alpha.mean():6.3f}"
        f" {np.percentile(alpha, 1.0):6.3f} {alpha.min():6.3f}")  # fmt: skip


def by_surfmesh(bodies: list) -> Peer:
    model = sm.intersect(bodies, keep="union")
    mesh = sm.mesh(model, SIZE)
    return Peer(mesh.points, mesh.triangles, model.volume)


def by_gmsh(bodies: tuple) -> Peer:
    import gmsh

    gmsh.initialize()
    try:
        gmsh.option.setNumber("General.Verbosity", 0)
        gmsh.option.setNumber("General.NumThreads", 1)
        occ = gmsh.model.occ
        add = {"cylinder": occ.addCylinder, "box": occ.addBox, "sphere": occ.addSphere}
        made = [(3, add[kind](*numbers)) for kind, numbers, _ in bodies]
        for own, (_, _, axes) in zip(made, bodies):
            if axes:
                occ.dilate([own], 0, 0, 0, *axes)
        united, _ = occ.fuse(made[:1], made[1:])
        occ.synchronize()
        volume = sum(occ.getMass(3, tag) for _, tag in united)
        gmsh.option.setNumber("Mesh.MeshSizeMax", SIZE)
        gmsh.option.setNumber("Mesh.MeshSizeMin", SIZE)
        gmsh.model.mesh.generate(2)
        nodes, places, _ = gmsh.model.mesh.getNodes()
        _, corners = gmsh.model.mesh.getElementsByType(2)
    finally:
        gmsh.finalize()
    row = np.zeros(int(nodes.max()) + 1, np.int64)
    row[nodes.astype(np.int64)] = np.arange(len(nodes))
    return Peer(places.reshape(-1, 3), row[corners.astype(np.int64)].reshape(-1, 3), volume)


def by_manifold(bodies: list) -> Peer:
    """The boolean of meshes of the bodies; its volume is that of the mesh."""
    import manifold3d

    made: Any = None
    for body in bodies:
        mesh = sm.mesh(body, SIZE)
        a, b, c = np.moveaxis(mesh.points[mesh.triangles], 1, 0)
        outwards = np.einsum("ij,ij->", a, np.cross(b, c)) > 0.0
        triangles = mesh.triangles if outwards else mesh.triangles[:, ::-1]
        given = manifold3d.Mesh(
            vert_properties=mesh.points.astype(np.float32), tri_verts=triangles.astype(np.uint32)
        )
        own = manifold3d.Manifold(given)
        made = own if made is None else made + own
    result = made.to_mesh()
    points = np.asarray(result.vert_properties, float)[:, :3]
    return Peer(points, np.asarray(result.tri_verts, np.int64), made.volume())


PARTS = {"curves": curves, "solids": solids, "quality": quality, "peers": peers}


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("parts", nargs="*", default=[], help="curves waves solids quality peers")
    parser.add_argument("--heights", type=int, default=200)
    options = parser.parse_args()
    warm = sm.intersect([sphere(0, 0, 0, "a"), sphere(1, 0, 0, "b")], keep="union")
    sm.check(sm.mesh(warm, 0.5))  # what is imported for the first time is not measured
    for part in options.parts or [*PARTS, "waves"]:
        if part == "waves":
            waves(options.heights)
        else:
            PARTS[part]()


if __name__ == "__main__":
    main()
