"""Tables 1 and 2 of Wang, Ming and Lo (2007), the paper's figures beside ours. One command:

    python benchmarks/paper.py [--quick] [--json PATH] [--growth 1.15]

Table 1: circles of random radius, 1 to 100, and how time grows with their number. Table 2: the
five examples, raw and optimised. A single thread. Exits with 1 when a wanted figure is missed.
"""

import single_thread  # noqa: F401  (before numpy)

# isort: split
import argparse
import sys
import time

import numpy as np
import table_2
from tables import concluded, heading, note, show
from wanted import Wanted

import surfmesh as sm
from surfmesh.errors import SurfmeshError

COUNTS = [10_000, 20_000, 40_000, 60_000, 80_000, 100_000, 1_000_000]
QUICK_COUNTS = [10_000, 30_000, 100_000]
REPEATS = 3  # the fastest is taken
PAPER_TABLE_1 = {
    10_000: {"elements": 19_610, "seconds": 1.496},
    100_000: {"elements": 198_720, "seconds": 15.112},
}  # the first and the last row
PER_CIRCLE = 0.005  # elements a circle, relative difference from the paper's

TABLE_1 = {
    "elements": Wanted("elements", digits=0),
    "seconds": Wanted("seconds", digits=4),
    "whole": Wanted("seconds with the statistics", digits=4),
    "off": Wanted("elements a circle, off the paper's", most=PER_CIRCLE, percent=True, digits=2),
    "rate": Wanted("elements a second", least=1e6, digits=0),
}
SLOPE = {
    "above": Wanted("time ~ circles ^", most=1.05),
    "below": Wanted("time ~ circles ^", least=0.95),
}


def main() -> int:
    options = _options()
    results: dict = {"growth": options.growth}
    missed = _table_1(QUICK_COUNTS if options.quick else COUNTS, results)
    missed += _table_2(options.growth, results)
    results["missed"] = missed
    return concluded(missed, results, options.json)


def _options() -> argparse.Namespace:
    parser = argparse.ArgumentParser(description="Tables 1 and 2 of the paper.")
    parser.add_argument("--quick", action="store_true", help=f"circles {QUICK_COUNTS} only")
    parser.add_argument("--json", metavar="PATH", help="write everything as one JSON object")
    parser.add_argument("--growth", type=float, default=1.15, help="of the surfaces' sizes")
    return parser.parse_args()


def _table_1(counts: list[int], results: dict) -> int:
    sm.pack(sm.UniformRadius(1.0, 100.0), count=1000)  # imports, outside the clock
    rows = {count: _random_packing(count) for count in counts}
    slope = float(np.polyfit(*np.log([[n, row["seconds"]] for n, row in rows.items()]).T, 1)[0])
    results["table_1"] = {"rows": rows, "slope": slope}
    heading("Table 1: circles of random radius from 1 to 100")
    paper = {f"paper {n:,}": row for n, row in PAPER_TABLE_1.items()}
    missed = show(TABLE_1, {f"{n:,}": row for n, row in rows.items()}, paper)
    return missed + show(SLOPE, {"": dict.fromkeys(SLOPE, slope)})


def _random_packing(count: int) -> dict:
    best, whole = np.inf, np.inf
    for _ in range(REPEATS):
        start = time.perf_counter()
        figures = sm.pack(sm.UniformRadius(1.0, 100.0, seed=0), count=count).statistics
        whole = min(whole, time.perf_counter() - start)
        best = min(best, figures.seconds)
    row = {
        "elements": figures.elements,
        "seconds": best,
        "whole": whole,
        "rate": figures.elements / best,
    }
    if count in PAPER_TABLE_1:
        row["off"] = abs(figures.elements / PAPER_TABLE_1[count]["elements"] - 1.0)
    return row


def _table_2(growth: float, results: dict) -> int:
    results["table_2"] = found = {}
    missed = 0
    for name in table_2.PAPER:
        columns = {}
        try:
            if name == table_2.RANDOM:
                columns["raw"] = table_2.random_figures()
            else:
                surface = sm.load(name)
                sizing = table_2.sizing_at_papers_count(name, growth)
                for title, optimise in (("raw", False), ("optimised", True)):
                    columns[title] = table_2.mesh_figures(surface, sizing, optimise)
        except SurfmeshError as error:
            columns["failed"] = f"{type(error).__name__}: {error}"
            missed += 1
        found[name] = columns
        for title, row in columns.items():
            heading(f"Table 2, {name}: {title}")
            if title == "failed":
                note(row)
                continue
            rows = table_2.wanted(name, optimised=title == "optimised")
            missed += show(rows, {"surfmesh": row}, {"paper, raw": table_2.PAPER[name]})
    if row := found[table_2.RANDOM].get("raw"):
        note(
            f"random size: means over {table_2.SEEDS} packings; Avg2 is from "
            f"{row['avg2_least']:.2f} to {row['avg2_most']:.2f}"
        )
    return missed


if __name__ == "__main__":
    sys.exit(main())
