"""Hostile input, saves at limits, a soak and a second opinion: what can be relied on, in figures.

    python benchmarks/trust.py                       # all; SURFMESH_FUZZ=N or --count N a kind
    python benchmarks/trust.py --only .vtu command --count 2000 --seed 7
    python benchmarks/trust.py --only .vtu --numbers 122 --keep FOLDER   # one again, as a file
    python benchmarks/trust.py --parts readers --folder HOSTILE          # files of a folder as well

Readers: seeded mutants of small good files (``tests/fuzz``), tried in processes of their own.
Refused is one line; read is a mesh, model or surface that holds together. Exit status 1 where
anything crashed, hung, ended in a traceback, took too much memory, was read in part without a
word, was not quiet, or where a saved file was broken or an opinion differed.
"""

import single_thread  # noqa: F401  (before numpy)

# isort: split
import argparse
import json
import os
import subprocess
import sys
import time
from collections import Counter
from collections.abc import Iterable
from dataclasses import dataclass, field
from pathlib import Path

from rich.box import SIMPLE_HEAD
from rich.table import Table
from tables import console, heading, note

sys.path.insert(0, str(Path(__file__).resolve().parents[1] / "tests"))
from fuzz import trials

COUNT = 300  # mutants a kind
SHARE = {"step": 0.2, "iges": 0.2, "brep": 0.2, "surface": 0.5, "command": 0.5}  # of the count
SHOWN = 3  # faults of one kind that are shown
COLUMNS = ("tried", "refused", "read", *trials.FAULTS)
PARTS = ("readers", "formulas", "random", "saves", "soak", "opinion")


@dataclass
class Row:
    """What became of all trials of one kind."""

    ends: Counter = field(default_factory=Counter)
    seconds: float = 0.0
    megabytes: float = 0.0
    faults: list[trials.Trial] = field(default_factory=list)

    def add(self, trial: trials.Trial) -> None:
        self.ends.update(("tried", trial.ended))
        self.seconds = max(self.seconds, trial.seconds)
        self.megabytes = max(self.megabytes, trial.megabytes)
        if trial.is_fault:
            self.faults.append(trial)

    def plain(self) -> dict:
        faults = [{"name": t.name, "ended": t.ended, "said": t.said} for t in self.faults]
        figures = {name: self.ends[name] for name in COLUMNS}
        return figures | {"seconds": self.seconds, "megabytes": self.megabytes, "faults": faults}


def main() -> int:
    options = _options()
    found: dict[str, object] = {}
    broken = 0
    for part in options.parts:
        figures, faults = globals()[f"_{part}"](options)
        found[part] = figures
        broken += faults
    if options.json:
        options.json.write_text(json.dumps(found, indent=2) + "\n", encoding="utf-8")
    return int(broken > 0)


def _options() -> argparse.Namespace:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    count = int(os.environ.get("SURFMESH_FUZZ") or COUNT)
    parser.add_argument("--count", type=int, default=count, help="mutants a kind (CAD: a fifth)")
    parser.add_argument("--seed", type=int, default=0, help="of the mutants")
    parser.add_argument("--numbers", type=int, nargs="+", help="these mutants alone")
    parser.add_argument("--only", nargs="+", choices=trials.KINDS, help="kinds of input")
    parser.add_argument("--folder", type=Path, help="hostile files that are tried as well")
    parser.add_argument("--keep", type=Path, help="where mutants that are faults are written")
    parser.add_argument(
        "--parts", nargs="+", choices=PARTS, help="all without; with --only: readers"
    )
    parser.add_argument("--soak", type=int, default=1000, help="meshes of the soak")
    parser.add_argument("--corpus", type=Path, help="CAD files for the second opinion")
    parser.add_argument("--json", type=Path, help="write the figures too")
    options = parser.parse_args()
    options.parts = options.parts or (["readers"] if options.only else PARTS)
    return options


def _readers(options: argparse.Namespace) -> tuple[dict, int]:
    """The table of mutants, and of the files of a folder by their kind."""
    heading(f"Hostile input, seed {options.seed}")
    rows = {}
    for kind in options.only or trials.KINDS:
        numbers = options.numbers or range(max(1, round(SHARE.get(kind, 1.0) * options.count)))
        rows[kind] = _row(kind, trials.mutants(kind, options.seed, numbers), options.keep)
    if options.folder:
        paths = sorted(path for path in options.folder.rglob("*") if path.is_file())
        tasks = trials.files(paths)
        for kind in dict.fromkeys(task.kind for task in tasks):
            own = [task for task in tasks if task.kind == kind]
            rows[f"{kind} of the folder"] = _row(kind, own, None)
    _show(rows)
    return {kind: row.plain() for kind, row in rows.items()}, sum(
        len(r.faults) for r in rows.values()
    )


def _row(kind: str, tasks: list[trials.Task], keep: Path | None) -> Row:
    row, start = Row(), time.perf_counter()
    for task, trial in zip(tasks, trials.tried(tasks)):
        row.add(trial)
        if trial.is_fault and keep:
            keep.mkdir(parents=True, exist_ok=True)
            place = keep / f"{kind.strip('.')}.{task.name}{trials.EXTENSION.get(kind, '.json')}"
            place.write_bytes(task.make().data)
    print(f"{kind}: {len(tasks)} in {time.perf_counter() - start:.0f} s", file=sys.stderr)
    return row


def _show(rows: dict[str, Row]) -> None:
    table = Table(box=SIMPLE_HEAD)
    table.add_column("", no_wrap=True)
    for title in (*COLUMNS, "seconds", "MB"):
        table.add_column(title, justify="right", no_wrap=True)
    total = Row()
    for kind, row in rows.items():
        _add(table, kind, row)
        total.ends.update(row.ends)
        total.seconds = max(total.seconds, row.seconds)
        total.megabytes = max(total.megabytes, row.megabytes)
    _add(table, "all", total)
    console.print(table)
    note("seconds of the processor and MB over the interpreter's own: the largest of one input")
    for kind, row in rows.items():
        _show_faults(kind, row.faults)


def _add(table: Table, kind: str, row: Row) -> None:
    figures = [f"{row.ends[name]:,}" for name in COLUMNS]
    table.add_row(kind, *figures, f"{row.seconds:.1f}", f"{row.megabytes:.0f}")


def _show_faults(kind: str, faults: Iterable[trials.Trial]) -> None:
    """A few, each reason once."""
    seen = {}
    for trial in faults:
        seen.setdefault((trial.ended, trial.said.strip().splitlines()[-1][-80:]), trial)
    for trial in list(seen.values())[:SHOWN]:
        console.print(f"{kind} {trial.name}: {trial.ended}", markup=False)
        console.print(f"    {trial.said.strip()[-600:]!r}", markup=False)


def _formulas(options: argparse.Namespace) -> tuple[dict, int]:
    """The grammar of formulas: the tests that draw from it, with as many examples as mutants."""
    heading("Formulas of a grammar")
    test = Path(__file__).resolve().parents[1] / "tests" / "fuzz" / "test_formulas.py"
    command = [sys.executable, "-m", "pytest", "-q", "-n", "0", str(test)]
    known = os.environ | {"SURFMESH_FUZZ": str(options.count)}
    done = subprocess.run(command, env=known, check=False)
    return {"exit_status": done.returncode}, int(done.returncode != 0)


def _random(options: argparse.Namespace) -> tuple[dict, int]:
    """Random parts, domains and surfaces before their own judge."""
    counts = {"parts": 5, "domains": 2, "surfaces": 3}
    words = [f"--{name}={max(1, options.count // part)}" for name, part in counts.items()]
    return _beside("random_inputs", "Random parts, domains and surfaces", *words)


def _saves(options: argparse.Namespace) -> tuple[dict, int]:
    return _beside("saves_at_limits", "Saves at limits")


def _beside(script: str, title: str, *words: str) -> tuple[dict, int]:
    """Another script of this folder, which prints its own table; its exit status counts."""
    heading(title)
    done = subprocess.run(
        [sys.executable, str(Path(__file__).parent / f"{script}.py")], check=False
    )
    return {"exit_status": done.returncode}, int(done.returncode != 0)


def _soak(options: argparse.Namespace) -> tuple[dict, int]:
    """In a process of its own: what the other parts have loaded is no part of it."""
    heading(f"Soak of {options.soak} meshes in one process")
    script = Path(__file__).parent / "soak.py"
    command = [sys.executable, str(script), "--count", str(options.soak)]
    done = subprocess.run(command, stdout=subprocess.PIPE, text=True, check=True)
    found = json.loads(done.stdout)
    for name, value in found.items():
        print(f"  {name.replace('_', ' ')}: {value:,.6g}")
    return found, int(found["grows"])


def _opinion(options: argparse.Namespace) -> tuple[dict, int]:
    corpus = [str(options.corpus)] if options.corpus else []
    return _beside("second_opinion", "A second opinion", *corpus)


if __name__ == "__main__":
    sys.exit(main())
