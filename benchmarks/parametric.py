"""The figures of meshing parametric surfaces, other meshers beside them. One command:

    python benchmarks/parametric.py [--quick] [--json PATH] [--surface NAME|FILE ...]
                                    [--sizes 10000 100000 1000000] [--growth 1.15] [--no-gmsh]

Everything runs on a single thread. A: meshes of wanted counts. B: other meshers. C: accuracy of
the size field. Exits with 1 when a wanted figure is missed. The paper's own figures:
``paper.py``; how fast it all is, and how it starts: ``speed.py``.
"""

import single_thread  # noqa: F401  (before numpy)

# isort: split
import argparse
import os
import platform
import sys

import field_accuracy
import measures
import memory
import numpy as np
import peers
import wanted
from tables import concluded, heading, note, show
from target_count import diagonal, sizing_for

import surfmesh as sm
from surfmesh.errors import SurfmeshError

SURFACES = ["wavy", "two_peaks"]
SIZES = [10_000, 100_000, 1_000_000]
QUICK_SIZES = [10_000]
REPEATS = {50_000: 5, 300_000: 3}  # up to so many triangles; one run above
BUSY = 1.3  # load average above which a second process took its share
PEER_MOST = 150_000  # triangles
PEER_SECONDS = 120.0  # a size is left out when the one before foretells more
PEER_TIMEOUT = 400.0  # the clock of the process: sizes asked for point by point are slow


def main() -> int:
    options = _options()
    sizes = sorted(options.sizes or (QUICK_SIZES if options.quick else SIZES))
    names = options.surface or SURFACES
    results = {"machine": _machine(), "growth": options.growth, "surfaces": {}}
    _warm_up()
    missed = 0
    for name in names:
        found = results["surfaces"].setdefault(name, {})
        try:
            missed += _meshes(name, sizes, options, found)
        except SurfmeshError as error:
            missed += _failed(name, error, found)
    missed += _field(names, options, results)
    results["missed"] = missed
    results["machine"]["load"] = load = os.getloadavg()[0] if hasattr(os, "getloadavg") else None
    if load is not None and load > BUSY:
        note(f"load average {load:.1f}: other work was running, the seconds are too long")
    note("")
    return concluded(missed, results, options.json)


def _options() -> argparse.Namespace:
    parser = argparse.ArgumentParser(
        description="The figures of meshing parametric surfaces.",
        epilog=f"default surfaces: {' '.join(SURFACES)}; default sizes: {SIZES}",
    )
    parser.add_argument("--quick", action="store_true", help=f"sizes {QUICK_SIZES} only")
    parser.add_argument("--json", metavar="PATH", help="write everything as one JSON object")
    parser.add_argument("--surface", nargs="+", metavar="NAME|FILE", help="gallery or .toml file")
    parser.add_argument("--sizes", nargs="+", type=int, metavar="N", help="triangles wanted")
    parser.add_argument("--growth", type=float, default=1.15, help="of the sizes, default 1.15")
    parser.add_argument("--no-gmsh", action="store_true", help="leave other meshers out")
    return parser.parse_args()


def _machine() -> dict:
    return {
        "python": platform.python_version(),
        "numpy": np.__version__,
        "surfmesh": sm.__version__,
        "processor": platform.processor() or platform.machine(),
        "threads": 1,
    }


def _warm_up() -> None:
    """Everything imported that a mesh and its report need, SymPy too."""
    for optimise in (True, False):
        sm.check(sm.mesh(sm.load("two_peaks"), sm.Sizing(chord=0.02), optimise=optimise))


def _failed(name: str, error: SurfmeshError, found: dict) -> int:
    """A surface that surfmesh refuses counts as one figure missed."""
    found["error"] = f"{type(error).__name__}: {error}"
    heading(f"{name}: FAILED")
    note(found["error"])
    return 1


# A and B


def _meshes(name: str, sizes: list[int], options: argparse.Namespace, found: dict) -> int:
    surface = sm.load(name)
    found["meshes"], found["peers"] = {}, {}
    start = None
    for size in sizes:
        sizing = sizing_for(surface, size, options.growth, start=start)
        start = sizing, size
        repeats = next((r for most, r in REPEATS.items() if size <= most), 1)
        row = measures.measured(name, sizing, repeats)
        row["sizing"] = sizing
        row["packing_triangles_a_second"] = measures.packing_rate(name, sizing, repeats)
        row |= memory.bytes_a_triangle(name, sizing, diagonal(surface))
        found["meshes"][size] = row
    heading(f"A. {name}: formulas to checked mesh, growth {options.growth:g}")
    for size, row in found["meshes"].items():
        note(f"{size:,}: {_sizing_text(row['sizing'], diagonal(surface))}")
    missed = show(wanted.MESH, {f"{size:,}": row for size, row in found["meshes"].items()})
    for size, row in found["meshes"].items():
        stages = ", ".join(f"{k} {v:.3f}" for k, v in row["seconds_by_stage"].items())
        note(f"{size:,}: seconds {stages} (fastest of {row['repeats']})")
        worst = row["worst"]
        note(
            f"{size:,}: of the {worst['of']} worst triangles {worst['at_boundary']} touch the "
            f"boundary, {worst['near_sides']} lie within 2 % of a side; the worst is at (u, v) "
            f"= ({worst['uv'][0]:g}, {worst['uv'][1]:g})"
        )
        for text in [*row["problem_texts"], *filter(None, [row.get("error")])]:
            note(f"{size:,}: {text}")
    missed += _speed(found)
    if not options.no_gmsh:
        _peers(name, found)
    return missed


def _sizing_text(sizing: dict, extent: float) -> str:
    (option, value), *others = sizing.items()
    rest = "".join(f", {name} {other:g}" for name, other in others)
    return f"{option} {value:g} ({value / extent:.2g} of the diagonal){rest}"


def _speed(found: dict) -> int:
    """Speed at the size that counts, and how time grows with the count."""
    rows, columns = {}, {}
    meshes = found["meshes"]
    near = [row for size, row in meshes.items() if abs(size / wanted.SPEED_AT - 1) < 0.2]
    if near:
        rows["speed"] = wanted.Wanted(
            f"triangles a second at {wanted.SPEED_AT:,}", least=wanted.SPEED.least, digits=0
        )
        columns["speed"] = near[0]["triangles_a_second"]
    if len(meshes) > 1:
        logs = np.log([[row["triangles"], row["seconds_total"]] for row in meshes.values()])
        found["exponent"] = float(np.polyfit(*logs.T, 1)[0])
        rows["exponent"] = wanted.EXPONENT
        columns["exponent"] = found["exponent"]
    return show(rows, {"": columns}) if rows else 0


def _peers(name: str, found: dict) -> None:
    rows = {key: row for key, row in wanted.MESH.items() if key in PEER_ROWS}
    foretold = dict.fromkeys(peers.MESHERS, 0.0)
    for size, ours in found["meshes"].items():
        if size > PEER_MOST:
            continue
        others = {}
        for mesher in peers.MESHERS:
            if foretold[mesher] * size > PEER_SECONDS:
                others[mesher] = {"error": f"would take over {PEER_SECONDS:.0f} s"}
                continue
            others[mesher] = peers.peer(
                mesher, name, ours["sizing"], ours["triangles"], PEER_TIMEOUT
            )
            foretold[mesher] = others[mesher].get("seconds_total", PEER_TIMEOUT) / size
        found["peers"][size] = others
        heading(f"B. {name}: other meshers, the same wanted sizes")
        note(_sizing_text(ours["sizing"], diagonal(sm.load(name))))
        show(rows, {"surfmesh": ours}, others)
        for mesher, row in others.items():
            if "error" in row:
                note(f"{mesher}: {row['error']}")


PEER_ROWS = (
    "triangles", "alpha_mean", "alpha_p01", "alpha_min", "quasi_unit_share", "inverted", "folded",
    "deviation_over_chord", "above_chord", "seconds_total", "triangles_a_second",
)  # fmt: skip


# C


def _field(names: list[str], options: argparse.Namespace, results: dict) -> int:
    surfaces = [sm.load(name) for name in names] + [field_accuracy.bump()]
    results["field"] = {}
    columns = {}
    for surface in surfaces:
        try:
            found = field_accuracy.field_accuracy(surface, options.growth)
        except SurfmeshError as error:
            found = {"error": str(error)}
        results["field"][surface.name] = found
        columns[surface.name] = found
    heading("C. interpolated size tensor against the exact one, where gradation is inactive")
    missed = show(wanted.FIELD, columns)
    for name, found in columns.items():
        if "error" in found:
            note(f"{name}: {found['error']}")
        else:
            note(
                f"{name}: {found['compared']:,} of {found['sampled']:,} random points compared; "
                f"largest at (u, v) = ({found['uv'][0]:.6g}, {found['uv'][1]:.6g})"
            )
    return missed


if __name__ == "__main__":
    sys.exit(main())
