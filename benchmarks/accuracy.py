"""Accuracy proved: how much of each mesh, how tight, at what cost, and against points at random.

    python benchmarks/accuracy.py                          the gallery at diag/1000 and diag/10000
    python benchmarks/accuracy.py --names torus wavy       some of it
    python benchmarks/accuracy.py --parts a.step b.iges    CAD files too, at diag/1000 or --fraction
    python benchmarks/accuracy.py --proof                  sizes made smaller until it is
    python benchmarks/accuracy.py --efficiency             triangles over the least, instead
    python benchmarks/accuracy.py --efficiency --fewest    the same, stretched as few as can be

A line each, as soon as it is measured: triangles; the share proved to keep to the chord both ways;
largest bound / chord; median of bound / sampled distance; processor time of the proof over that of
the mesh; the largest distance of random points both ways / chord, by VTK's closest triangle and the
core's closest point, and how many of them are beyond the bounds. Of CAD files there is a table by
kind of surface in the end: faces, those not proved; triangles, those without bound; share proved.

With --efficiency: triangles of an isotropic mesh and of one stretched up to 100, each over the
least of any shape and the isotropic over what equilateral ones need; mean alpha; the largest
distance both ways of random points / chord. With --fewest the meshes have as few as keep the chord
(``Sizing(fewest=True)``), and each line comes a second time with growth 4 instead of the
default.
"""

import single_thread  # noqa: F401  (before numpy)

# isort: split
import argparse
import time
from collections import Counter
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

import surfmesh as sm
from surfmesh.errors import SurfmeshError
from surfmesh.geometry.differential.projection import closest_point
from surfmesh.quality.measures.measurements import Measurements
from surfmesh.quality.measures.proof import Proof
from surfmesh.result.surface_mesh import SurfaceMesh

FRACTIONS = (1_000, 10_000)
POINTS = 20_000
ROUNDING = 1e-9  # of the chord, of the independent look

GROWTH = sm.Sizing().growth
USUAL = ((1.0, GROWTH), (100.0, GROWTH))  # ratio and growth of the meshes of --efficiency
FEWEST = ((1.0, GROWTH), (1.0, 4.0), (100.0, GROWTH), (100.0, 4.0))


class Looked(NamedTuple):
    """The largest distances at random points, and how many are beyond what is proved."""

    from_mesh: float
    from_surface: float
    above: int


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--names", nargs="*", help="of the gallery; all by default")
    parser.add_argument("--parts", nargs="*", default=[], help="CAD files")
    parser.add_argument("--fraction", type=int, default=FRACTIONS[0], help="of CAD files: diag/...")
    parser.add_argument("--proof", action="store_true", help="Sizing(proof=True)")
    parser.add_argument("--efficiency", action="store_true", help="triangles over the least")
    parser.add_argument("--fewest", action="store_true", help="Sizing(fewest=True)")
    options = parser.parse_args()
    if options.efficiency:
        show_efficiency(options.names, options.parts, options.fewest)
        return
    print(f"{'':24s} {'diag/':>6s} {'triangles':>9s} {'proved':>8s} {'bound':>6s} "
          f"{'tight':>6s} {'cpu':>5s} {'random points':>15s} {'above':>5s}")  # fmt: skip
    for name in sm.gallery() if options.names is None else options.names:
        surface = sm.load(name)
        if isinstance(surface, sm.PlanarDomain):
            continue
        diagonal = float(np.linalg.norm(np.ptp(sm.mesh(surface).points, axis=0)))
        for fraction in FRACTIONS:
            show(name, surface, diagonal / fraction, fraction, options.proof)
    kinds: dict[str, NDArray[np.int64]] = {}
    for path in options.parts:
        model = sm.load(path)
        name = path.rsplit("/", 1)[-1][-24:]
        found = show(
            name, model, model.diagonal / options.fraction, options.fraction, options.proof
        )
        for kind, row in found.items():
            kinds[kind] = kinds.get(kind, np.zeros_like(row)) + row
    for kind, (faces, left, triangles, proved, unbounded) in sorted(kinds.items()):
        print(f"{kind:12s} {faces:6,d} faces, {left:4,d} left {triangles:10,d} triangles, "
              f"{unbounded:6,d} without bound {100 * proved / triangles:8.3f} %")  # fmt: skip


def show(
    name: str, thing: object, chord: float, fraction: int, proof: bool
) -> dict[str, NDArray[np.int64]]:
    """One line. Counts by kind of surface: faces, not proved; triangles, proved, without bound."""
    start = time.process_time()
    try:
        mesh = sm.mesh(thing, sm.Sizing(chord=chord, proof=proof), strict=False, jobs=1)
    except SurfmeshError as error:
        print(f"{name:24s} {fraction:6d} {error}", flush=True)
        return {}
    meshed = time.process_time() - start
    measured = Measurements(mesh)
    if measured.deviation_both_ways is None:  # measured before the clock starts
        return {}
    start = time.process_time()
    found = measured.proof
    proved = time.process_time() - start
    if found is None:
        return {}
    looked = at_random(mesh, found.bound)
    open_faces = np.unique(mesh.face_ids[~found.is_proved])
    kinds = Counter(getattr(mesh.surfaces[k], "kind", "formula") for k in open_faces)
    left = " ".join(f"{kind} {count}" for kind, count in sorted(kinds.items()))
    tight = float("nan") if found.over_sampled is None else found.over_sampled
    share = 100 * found.is_proved.mean()
    print(f"{name:24s} {fraction:6d} {len(mesh.triangles):9,d} {share:7.3f}% "
          f"{found.bound.max() / chord:6.3f} {tight:6.3f} {proved / meshed:5.2f} "
          f"{looked.from_surface / chord:7.3f} {looked.from_mesh / chord:7.3f} {looked.above:5d} "
          f"{left and 'faces left: ' + left}", flush=True)  # fmt: skip
    return by_kind(mesh, found)


def by_kind(mesh: SurfaceMesh, found: Proof) -> dict[str, NDArray[np.int64]]:
    """Faces, those not proved; triangles, those proved, those without any bound."""
    kinds: dict[str, NDArray[np.int64]] = {}
    for number in np.unique(mesh.face_ids).tolist():
        own = mesh.face_ids == number
        good, unbounded = found.is_proved[own], ~np.isfinite(found.bound[own])
        row = np.array([1, not good.all(), len(good), good.sum(), unbounded.sum()], np.int64)
        kind = getattr(mesh.surfaces[number], "kind", "formula")
        kinds[kind] = kinds.get(kind, np.zeros_like(row)) + row
    return kinds


def show_efficiency(names: list[str] | None, parts: list[str], fewest: bool) -> None:
    """A line for each surface or model, chord and ratio."""
    print(f"{'':24s} {'diag/':>6s} {'ratio':>5s} {'triangles':>9s} {'/ least':>8s} "
          f"{'/ equil.':>8s} {'alpha':>7s} {'random points':>15s}")  # fmt: skip
    for name in [*(sm.gallery() if names is None else names), *parts]:
        thing = sm.load(name)
        if isinstance(thing, sm.PlanarDomain):
            continue
        diagonal = float(np.linalg.norm(np.ptp(sm.mesh(thing).points, axis=0)))
        for fraction in FRACTIONS:
            for ratio, growth in FEWEST if fewest else USUAL:
                sizing = sm.Sizing(
                    chord=diagonal / fraction, anisotropy=ratio, growth=growth, fewest=fewest
                )
                mesh = sm.mesh(thing, sizing, strict=False, jobs=1)
                found, chord = sm.check(mesh), diagonal / fraction
                looked = at_random(mesh, np.zeros(len(mesh.triangles)))
                count, least = len(mesh.triangles), found.least_triangles or np.nan
                alike = found.equilateral_triangles or np.nan
                print(f"{name[-24:]:24s} {fraction:6d} {ratio:5.0f} {count:9,d} "
                      f"{count / least:8.3f} {count / alike:8.3f} {found.alpha_mean:7.4f} "
                      f"{looked.from_surface / chord:7.3f} {looked.from_mesh / chord:7.3f} "
                      f"{'' if growth == GROWTH else f'growth {growth:g} '}"
                      f"{'' if found.clean else 'not clean'}", flush=True)  # fmt: skip


def at_random(mesh: SurfaceMesh, bound: NDArray[np.float64]) -> Looked:
    """Points of the surface over triangles, and of the triangles, drawn by number."""
    rng = np.random.default_rng(17)
    triangle = rng.integers(0, len(mesh.triangles), POINTS)
    weights = rng.dirichlet((1.0, 1.0, 1.0), POINTS)
    uv = np.einsum("kc,kcd->kd", weights, mesh.uv[triangle])
    flat = np.einsum("kc,kcd->kd", weights, mesh.points[mesh.triangles[triangle]])
    points, back = np.empty((POINTS, 3)), np.empty(POINTS)
    for number in np.unique(mesh.face_ids[triangle]):
        rows = np.flatnonzero(mesh.face_ids[triangle] == number)
        surface = mesh.surfaces[number]
        points[rows] = surface.evaluate(uv[rows], 0)[0]
        back[rows] = closest_point(surface, flat[rows], uv[rows], 20)[1]
    cells = mesh.to_pyvista()
    _, nearest = cells.find_closest_cell(points, return_closest_point=True)
    there = np.linalg.norm(points - nearest, axis=1)
    at_vertex = np.zeros(len(mesh.points))
    np.maximum.at(at_vertex, mesh.triangles.ravel(), np.repeat(bound, 3))
    around = at_vertex[mesh.triangles[triangle]].max(axis=1)
    slack = ROUNDING * float(np.median(bound)) + 1e-12 * float(np.abs(mesh.points).max())
    # a point over the straight triangle of (u, v) may be of the bent piece of one beside it
    above = (there > around + slack) | (back > around + slack)
    return Looked(float(back.max()), float(there.max()), int(np.count_nonzero(above)))


if __name__ == "__main__":
    main()
