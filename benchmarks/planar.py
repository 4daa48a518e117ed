"""Planar domains against Triangle and gmsh, the same wanted sizes in the same run. One command:

    python benchmarks/planar.py [--quick] [--json PATH] [--sizes 10000 100000 1000000]

A single thread, each mesher in a process of its own. Nothing is judged: figures side by side.
"""

import single_thread  # noqa: F401  (before numpy)

# isort: split
import argparse
import json
import math
import sys
from pathlib import Path

import planar_peers
from tables import console, heading, note, show
from wanted import Wanted

SIZES = [10_000, 100_000, 1_000_000]
QUICK_SIZES = [10_000]
TIMEOUT = 400.0  # seconds, of one mesher at one size
MOST_SECONDS = 120.0  # a size is left out when the one before foretells more
START = {"uniform": 0.015, "graded": 0.004}  # sizes of the first trial
TRIALS = 3
NEAR_ENOUGH = 0.03  # relative, of the triangles

ROWS = {
    "triangles": Wanted("triangles", digits=0),
    "alpha_mean": Wanted("alpha, mean", digits=4),
    "alpha_min": Wanted("alpha, smallest", digits=4),
    "min_angle_deg": Wanted("smallest angle, degrees", digits=2),
    "quasi_unit_share": Wanted("quasi-unit edges", percent=True, digits=2),
    "length_mean": Wanted("length over the wanted, mean"),
    "length_std": Wanted("length over the wanted, deviation"),
    "seconds": Wanted("seconds"),
    "triangles_a_second": Wanted("triangles a second", digits=0),
}


def main() -> int:
    options = _options()
    results: dict = {}
    for law in planar_peers.LAWS:
        scale, before = START[law], None
        slowness = dict.fromkeys(planar_peers.MESHERS, 0.0)
        results[law] = {}
        for size in sorted(options.sizes or (QUICK_SIZES if options.quick else SIZES)):
            if before:
                scale *= math.sqrt(before / size)
            scale, ours = _ours(law, scale, size)
            before = size
            columns = {"surfmesh": ours}
            for mesher in planar_peers.MESHERS:
                if mesher == "surfmesh":
                    continue
                if slowness[mesher] * size > MOST_SECONDS:
                    columns[mesher] = {"error": f"would take over {MOST_SECONDS:.0f} s"}
                    continue
                with console.status(f"{law}, {size:,} triangles: {mesher}"):
                    columns[mesher] = planar_peers.peer(mesher, law, scale, TIMEOUT)
                slowness[mesher] = columns[mesher].get("seconds", 0.0) / size
            results[law][size] = {"scale": scale, **columns}
            heading(f"{law} size, about {size:,} triangles, size {scale:.4g}")
            show(ROWS, {}, columns)
            for mesher, row in columns.items():
                if "error" in row:
                    note(f"{mesher}: {row['error']}")
    if options.json:
        Path(options.json).write_text(json.dumps(results, indent=2) + "\n")
        note(f"written to {options.json}")
    return 0


def _options() -> argparse.Namespace:
    parser = argparse.ArgumentParser(description="Planar domains against Triangle and gmsh.")
    parser.add_argument("--quick", action="store_true", help=f"sizes {QUICK_SIZES} only")
    parser.add_argument("--json", metavar="PATH", help="write everything as one JSON object")
    parser.add_argument("--sizes", nargs="+", type=int, metavar="N", help="triangles wanted")
    return parser.parse_args()


def _ours(law: str, scale: float, size: int) -> tuple[float, dict]:
    """The scale that gives about ``size`` triangles of ours, and our figures there."""
    for trial in range(TRIALS):
        with console.status(f"{law}, {size:,} triangles: surfmesh, trial {trial + 1}"):
            found = planar_peers.peer("surfmesh", law, scale, TIMEOUT)
        if "error" in found or abs(found["triangles"] / size - 1.0) < NEAR_ENOUGH:
            break
        if trial + 1 < TRIALS:
            scale *= math.sqrt(found["triangles"] / size)
    return scale, found


if __name__ == "__main__":
    sys.exit(main())
