"""How many triangles a measured deviation costs, isotropic and stretched. One command:

    python benchmarks/sizing.py [--quick] [--surface NAME|FILE ...] [--ratios 1 5 20 100]
                                [--deviations 1000 10000] [--most 400000] [--json PATH]

The deviation asked for is the diagonal over 1000 and over 10000; what is measured, on the result
and against the true surface, is given as a share of it. Other meshers have no place here yet.
Single-threaded. Exits with 1 when a mesh lies farther away than was asked for, or is folded.
"""

import single_thread  # noqa: F401  (before numpy)

# isort: split
import argparse
import json
import sys
from pathlib import Path
from time import perf_counter

import numpy as np
from rich.box import SIMPLE_HEAD
from rich.table import Table
from tables import console, heading
from target_count import diagonal

import surfmesh as sm
from surfmesh.errors import SurfmeshError
from surfmesh.geometry.formula_file import gallery
from surfmesh.geometry.parametric import ParametricSurface
from surfmesh.geometry.sides import find_sides
from surfmesh.quality.deviation import deviation
from surfmesh.quality.shape import shapes
from surfmesh.sizing.size_field import size_field

RATIOS = [1.0, 5.0, 20.0, 100.0]
DEVIATIONS = [1000.0, 10_000.0]
MOST = 400_000  # triangles; finer meshes are left out
QUICK = ["torus", "spring", "two_peaks", "cylinder", "wing"]
TURN = (0.0, 2.0 * np.pi)
MORE = {
    "tube 50": ("cos(u)", "sin(u)", "v", TURN, (0.0, 50.0)),
    "thin ring": (
        "(10 + 0.5*cos(v))*cos(u)", "(10 + 0.5*cos(v))*sin(u)", "0.5*sin(v)", TURN, TURN,
    ),
    "wing": (
        "(1 - v/16)*u**2 + v/4", "(1 - v/16)*0.18*u*(1 - u**2)*(1 + 0.6*u**2)", "v",
        (-1.0, 1.0), (0.0, 8.0),
    ),
}  # fmt: skip
COLUMNS = (
    "surface", "1/", "ratio", "triangles", "fewer", "largest", "median", "below half",
    "alpha", "least", "unit", "folded", "s",
)  # fmt: skip


def main() -> int:
    options = _options()
    names = options.surface or (QUICK if options.quick else [*_curved(), *MORE])
    rows, bad = [], 0
    heading("Triangles within a measured deviation")
    table = Table(*COLUMNS, box=SIMPLE_HEAD, padding=(0, 1))
    for name in names:
        surface = _surface(name)
        for share in options.deviations:
            first = None
            for ratio in options.ratios:
                row = _measured(surface, share, ratio, options.most)
                row = {"surface": name, "share": share, "ratio": ratio, **row}
                first = first or row.get("triangles")
                rows.append(row)
                bad += bool(row.get("largest", 0.0) > 1.0 or row.get("folded"))
                table.add_row(*_cells(row, first))
    console.print(table)
    if options.json:
        options.json.write_text(json.dumps(rows, indent=2))
    return int(bad > 0)


def _curved() -> list[str]:
    """Of the gallery, what has a curvature to follow."""
    return [name for name in gallery() if name != "plane" and not _is_planar(name)]


def _is_planar(name: str) -> bool:
    return not isinstance(sm.load(name), ParametricSurface)


def _surface(name: str) -> ParametricSurface:
    if name not in MORE:
        return sm.load(name)
    x, y, z, u, v = MORE[name]
    return ParametricSurface(x, y, z, u, v, name=name)


def _measured(surface: ParametricSurface, share: float, ratio: float, most: int) -> dict:
    chord = diagonal(surface) / share
    sizing = sm.Sizing(chord=chord, anisotropy=ratio)
    try:
        if 2 * size_field(surface, sizing, find_sides(surface)).expected_vertices() > most:
            return {"left_out": f"more than {most:,}"}
        start = perf_counter()
        mesh = sm.mesh(surface, sizing)
        seconds = perf_counter() - start
    except SurfmeshError as error:
        return {"left_out": f"{type(error).__name__}: {error}"}
    report = sm.check(mesh)
    used = deviation(mesh, shapes(mesh).area).by_triangle / chord
    stretched = report.alpha_metric_mean is not None
    return {
        "triangles": report.triangles,
        "largest": report.deviation_max / chord,
        "median": float(np.median(used)),
        "below_half": float((used < 0.5).mean()),
        "alpha_mean": report.alpha_metric_mean if stretched else report.alpha_mean,
        "alpha_min": report.alpha_metric_min if stretched else report.alpha_min,
        "quasi_unit": report.quasi_unit_share,
        "folded": report.folded,
        "seconds": seconds,
    }


def _cells(row: dict, first: int | None) -> list[str]:
    start = [row["surface"], f"{row['share']:g}", f"{row['ratio']:g}"]
    if "left_out" in row:
        return [*start, row["left_out"][:40], *[""] * (len(COLUMNS) - 4)]
    return [
        *start, f"{row['triangles']:,}", f"{(first or row['triangles']) / row['triangles']:.1f}",
        f"{row['largest']:.3f}", f"{row['median']:.2f}", f"{row['below_half']:.2f}",
        f"{row['alpha_mean']:.3f}", f"{row['alpha_min']:.3f}", f"{row['quasi_unit']:.3f}",
        str(row["folded"]), f"{row['seconds']:.2f}",
    ]  # fmt: skip


def _options() -> argparse.Namespace:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--quick", action="store_true", help="a few surfaces only")
    parser.add_argument("--surface", nargs="+", help="names of the gallery, or files")
    parser.add_argument("--ratios", nargs="+", type=float, default=RATIOS)
    parser.add_argument("--deviations", nargs="+", type=float, default=DEVIATIONS)
    parser.add_argument("--most", type=int, default=MOST, help="triangles; finer is left out")
    parser.add_argument("--json", type=Path, help="write all figures there")
    return parser.parse_args()


if __name__ == "__main__":
    sys.exit(main())
