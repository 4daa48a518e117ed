"""Random parts, planar domains and surfaces, meshed and judged by measures of their own.

    python benchmarks/random_inputs.py [--parts 100] [--domains 300] [--surfaces 200] [--seed 0]
        [--first 0] [--time-limit 60] [--json OUT.jsonl]

Each is a pure function of (seed, number): ``tests/judge/random_*.py``. The judge (``tests/judge``)
uses nothing of the mesher: index topology and Euler number, area and volume, edges that pierce
triangles, the distance both ways. Its verdict stands beside the report's: what the judge finds and
the report does not is silent, the reverse a false alarm. Prints what is not good with its number,
then a table; exits with 1 on silent faults, false alarms, crashes and numpy warnings.
"""

import single_thread  # noqa: F401  (before numpy)

# isort: split
import argparse
import json
import sys
from dataclasses import asdict
from pathlib import Path

from tables import console, heading

sys.path.insert(0, str(Path(__file__).parents[1] / "tests"))
from judge.judged_meshes import BAD, Trial, domain_trial, part_trial, surface_trial

KINDS = {"parts": part_trial, "domains": domain_trial, "surfaces": surface_trial}
COLUMNS = ("good", "found", "silent", "false alarm", "refused", "late", "crashed", "warned")


def main() -> int:
    options = _options()
    heading(f"random inputs, seed {options.seed}")
    out = open(options.json, "w", encoding="utf-8") if options.json else None
    trials: dict[str, list[Trial]] = {}
    for kind, tried in KINDS.items():
        trials[kind] = []
        for number in range(options.first, options.first + getattr(options, kind)):
            trial = tried(options.seed, number, options.time_limit)
            trials[kind].append(trial)
            if out:
                print(json.dumps(asdict(trial)), file=out, flush=True)
            if trial.outcome != "good":
                said = "; ".join(trial.said).replace("\n", " ")
                console.print(f"{trial.outcome}: {trial.name}: {said:.240}", markup=False)
    _table(trials)
    return int(any(trial.outcome in BAD for tried in trials.values() for trial in tried))


def _table(trials: dict[str, list[Trial]]) -> None:
    head = "".join(f"{column:>12}" for column in COLUMNS)
    console.print(f"{'':10}{'tried':>7}{head}{'triangles':>12}{'s':>7}{'slowest':>9}{'chord':>7}")
    for kind, tried in trials.items():
        if not tried:
            continue
        counts = "".join(f"{sum(t.outcome == c for t in tried):>12}" for c in COLUMNS)
        far = max((t.figures.get("deviation", 0.0) for t in tried), default=0.0)
        spent = [t.seconds for t in tried]
        console.print(
            f"{kind:10}{len(tried):>7}{counts}{sum(t.triangles for t in tried):>12,}"
            f"{sum(spent):>7.0f}{max(spent):>9.1f}{far:>7.2f}",
            markup=False,
        )


def _options() -> argparse.Namespace:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--parts", type=int, default=100)
    parser.add_argument("--domains", type=int, default=300)
    parser.add_argument("--surfaces", type=int, default=200)
    parser.add_argument("--seed", type=int, default=0)
    parser.add_argument("--first", type=int, default=0, help="number of the first of each")
    parser.add_argument("--time-limit", type=float, default=60.0, help="seconds of processor time")
    parser.add_argument("--json", type=Path, help="a line for each of them")
    return parser.parse_args()


if __name__ == "__main__":
    sys.exit(main())
