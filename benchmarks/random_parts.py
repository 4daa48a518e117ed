"""Random CadQuery parts, meshed and judged by measures of their own.

    python benchmarks/random_parts.py [--isotropic 300] [--stretched 200] [--seed 0]
        [--time-limit 60] [--json OUT.jsonl]

A part is a seed: a base shape, one to four features (holes, bosses, cuts, fillets, chamfers,
shells, patterns), of random sizes, turned at random. Invalid results of OpenCASCADE are left out.
Each is meshed in this process at a random sizing; the judge (``tests/judge``) uses nothing of the
mesher: index topology, volume and area against OpenCASCADE's, edges that pierce triangles, and
the distance both ways against a fine tessellation. Exits with 1 when a part fails.
"""

import single_thread  # noqa: F401  (before numpy)

# isort: split
import argparse
import json
import math
import signal
import sys
from pathlib import Path
from random import Random
from time import process_time

import cadquery as cq
from tables import console, heading

import surfmesh as sm

sys.path.insert(0, str(Path(__file__).parents[1] / "tests"))
from judge.random_parts import sizing_of, valid_part
from judge.solids import Verdict, judged

KINDS = ("isotropic", "stretched")


def main() -> int:
    options = _options()
    heading(f"random parts, seed {options.seed}")
    out = open(options.json, "w", encoding="utf-8") if options.json else None
    bad = 0
    for kind in KINDS:
        rows = []
        wanted, number = getattr(options, kind), 0
        while len(rows) < wanted:
            draw = Random(f"{options.seed} {kind} {number}")
            part, number = valid_part(draw), number + 1
            if part is None:
                continue
            row = _row(part, sizing_of(draw, part, kind == "stretched"), options.time_limit)
            row = {"kind": kind, "part": number - 1, **row}
            rows.append(row)
            if out:
                print(json.dumps(row), file=out, flush=True)
            if row["faults"]:
                console.print(f"{kind} part {number - 1}: {'; '.join(row['faults'])}", markup=False)
        bad += _summary(kind, rows)
    return int(bad > 0)


def _row(part: cq.Shape, sizing: sm.Sizing, limit: float) -> dict:
    """One part meshed and judged."""
    start = process_time()
    signal.signal(signal.SIGALRM, _too_long)
    signal.setitimer(signal.ITIMER_REAL, limit)
    try:
        mesh = sm.mesh(part, sizing)
        spent = process_time() - start
        report = sm.check(mesh)
    except sm.errors.SurfmeshError as error:
        spent = process_time() - start
        return {"faults": [f"refused: {error}"[:200]], "triangles": 0, "cpu": spent}
    except TimeoutError:
        return {"faults": [f"not done in {limit:g} s"], "triangles": 0, "cpu": limit}
    finally:
        signal.setitimer(signal.ITIMER_REAL, 0.0)
    found: Verdict = judged(mesh.points, mesh.triangles, part.wrapped, sizing.chord)
    faults = list(found.faults)
    if faults and report.clean:
        faults.append("and the report is clean")
    if not faults and not report.clean:
        faults = [f"not clean: {problem}"[:200] for problem in report.problems]
    return {
        "faults": faults, "clean": report.clean, "triangles": len(mesh.triangles), "cpu": spent,
        "faces": len(mesh.surfaces), "alpha_min": report.alpha_min, **found.figures,
    }  # fmt: skip


def _too_long(*_: object) -> None:
    raise TimeoutError


def _summary(kind: str, rows: list[dict]) -> int:
    """Print a line of figures; returns how many parts are at fault."""
    if not rows:
        return 0
    bad = sum(bool(row["faults"]) for row in rows)
    untrue = sum("and the report is clean" in row["faults"] for row in rows)
    made = [row for row in rows if row["triangles"]]
    far = max((row["deviation"] for row in made if row["deviation"] is not None), default=0.0)
    console.print(
        f"{kind}: {len(rows)} parts, {bad} at fault, {untrue} of them reported clean; "
        f"{sum(row['triangles'] for row in made):,} triangles, "
        f"{sum(row['cpu'] for row in rows):.0f} s, slowest "
        f"{max(row['cpu'] for row in rows):.1f} s; largest distance {far:.3g} chord",
        markup=False,
    )
    return bad


def _options() -> argparse.Namespace:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--isotropic", type=int, default=300)
    parser.add_argument("--stretched", type=int, default=200)
    parser.add_argument("--seed", type=int, default=0)
    parser.add_argument("--time-limit", type=float, default=60.0)
    parser.add_argument("--json", type=Path)
    options = parser.parse_args()
    if not math.isfinite(options.time_limit) or options.time_limit <= 0:
        parser.error("--time-limit must be positive")
    return options


if __name__ == "__main__":
    sys.exit(main())
