"""CAD models one by one, by surfmesh, gmsh and OpenCASCADE: closed? true? well shaped? how fast?

    python benchmarks/cad.py FOLDER_OR_FILES... [--json OUT.jsonl] [--only PATTERN ...]
        [--meshers ours,gmsh,ocp] [--most-faces N] [--time-limit 120] [--no-parts]
    python benchmarks/cad.py --summary OUT.jsonl

Every file and every CadQuery part of ``cad_parts.py``, each with each mesher in a process of its
own, with a time limit and one thread. One JSON object a line goes to ``--json`` as soon as it is
known; a table and the summary come at the end. Exits with 1 when a wanted figure is missed.
"""

import single_thread  # noqa: F401  (before numpy)

# isort: split
import argparse
import os
import platform
import sys
from collections.abc import Iterator
from fnmatch import fnmatch
from pathlib import Path
from time import perf_counter

import cad_meshers
import cad_summary
import json_lines
from cad_parts import PARTS
from tables import console, heading

from surfmesh.cad.reading.read_file import SUFFIXES

MESHERS = ("ours", "gmsh", "ocp")


def main() -> int:
    options = _options()
    if options.summary:
        return cad_summary.show(json_lines.read(options.summary))
    places = _places(options)
    if not places:
        console.print("no CAD file or part has such a name")
        return 2
    heading(f"{len(places)} models, {platform.machine()}, load {os.getloadavg()[0]:.1f}")
    records = (_said(record) for place in places for record in _measured(place, options))
    return cad_summary.show(json_lines.kept(records, options.json))


def _options() -> argparse.Namespace:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("paths", nargs="*", type=Path, help="folders and files")
    parser.add_argument("--json", type=Path, help="one JSON object a line, as it comes")
    parser.add_argument("--only", nargs="+", default=["*"], help="names, * and ? for any letters")
    parser.add_argument("--meshers", default=",".join(MESHERS), help="some of ours,gmsh,ocp")
    parser.add_argument("--most-faces", type=int, help="leave out models with more")
    parser.add_argument("--time-limit", type=float, default=120.0, help="seconds for each mesher")
    parser.add_argument("--no-parts", action="store_true", help="files only")
    parser.add_argument("--summary", type=Path, help="show what an earlier run has found")
    options = parser.parse_args()
    options.meshers = options.meshers.split(",")
    if unknown := set(options.meshers) - set(MESHERS):
        parser.error(f"unknown meshers {sorted(unknown)}; known: {', '.join(MESHERS)}")
    if missing := [str(path) for path in options.paths if not path.exists()]:
        parser.error(f"there is no {missing[0]}")
    return options


def _places(options: argparse.Namespace) -> list[str]:
    """Files, small ones first, and parts, that have a wanted name."""
    files = []
    for path in options.paths:
        files += path.iterdir() if path.is_dir() else [path]
    files = [path for path in files if path.suffix.lower() in SUFFIXES]
    files.sort(key=lambda path: (path.stat().st_size, path.name))
    names = [] if options.no_parts else [f"part:{name}" for name in PARTS]
    names += [str(path) for path in files]
    return [
        name for name in names
        if any(fnmatch(Path(name).name, pattern) for pattern in options.only)
    ]  # fmt: skip


def _measured(place: str, options: argparse.Namespace) -> Iterator[dict]:
    """What each mesher makes of one model. The first says what the model is and its sizes."""
    asked = {"most_faces": options.most_faces}
    first = "ours" if "ours" in options.meshers else "facts"
    known = _run(first, place, options, asked)
    yield known
    if "chord" not in known or known.get("left_out"):
        return
    asked = {name: known[name] for name in ("chord", "max_size", "diagonal")}
    asked["wanted"] = known.get("triangles")
    for mesher in options.meshers:
        if mesher != "ours":
            yield _run(mesher, place, options, asked)


def _run(mesher: str, place: str, options: argparse.Namespace, asked: dict) -> dict:
    start = perf_counter()
    found = cad_meshers.run(mesher, place, options.time_limit, **asked)
    seconds = perf_counter() - start
    return {"file": Path(place).name, "mesher": mesher, **found, "seconds_process": seconds}


def _said(record: dict) -> dict:
    """The record itself, after a line about it."""
    said = record.get("error") or ("left out" if record.get("left_out") else "")
    if not said:
        said = f"{record.get('triangles', '-')} triangles"
    console.print(
        f"{record['file']} {record['mesher']}: {said}, {record['seconds_process']:.1f} s",
        markup=False, highlight=False,
    )  # fmt: skip
    return record


if __name__ == "__main__":
    sys.exit(main())
