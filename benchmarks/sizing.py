"""How many triangles a measured deviation costs, isotropic and stretched, and what peers need.

    python benchmarks/sizing.py [FOLDER_OR_FILES...] [--only PATTERN ...] [--quick] [--peers-only]
        [--meshers ours,searched,gmsh,netgen,ocp] [--ratios 1 5 20 100] [--deviations 1000 10000]
        [--most 400000] [--time-limit 120] [--json OUT.jsonl]
    python benchmarks/sizing.py --summary OUT.jsonl

The gallery's formulas (by surfmesh alone), CAD faces of the same shapes, then the given CAD and
formula files. The deviation asked for is the diagonal over 1000 and over 10000. Ours is asked
once, and every triangle is to lie within; for a peer, and for ours once more, the setting is
searched for until 99.9 % do. Each mesher works in a process of its own with one thread. Exits
with 1 when a mesh of ours lies farther away than was asked for, or is folded.
"""

import single_thread  # noqa: F401  (before numpy)

# isort: split
import argparse
import os
import platform
import sys
import tempfile
from collections.abc import Iterator
from fnmatch import fnmatch
from pathlib import Path

import json_lines
import sizing_meshers
import sizing_summary
from sizing_meshers import FORMULA, SHAPE
from sizing_shapes import FORMULAS, SHAPES
from tables import console, heading

import surfmesh as sm
from surfmesh.cad.reading.read_file import SUFFIXES
from surfmesh.geometry.formulas.parametric import ParametricSurface

MESHERS = ("ours", "searched", "gmsh", "netgen", "ocp")
LARGEST = 0.1  # of the diagonal: the largest size of peers, the default of ours
QUICK = [
    f"{FORMULA}{name}" for name in ("torus", "spring", "two_peaks", "cylinder", "wing")
] + [f"{SHAPE}torus", f"{SHAPE}cone"]  # fmt: skip


def main() -> int:
    options = _options()
    if options.summary:
        return sizing_summary.show(json_lines.read(options.summary))
    places = _places(options)
    if not places:
        console.print("no surface or CAD file has such a name")
        return 2
    heading(f"{len(places)} inputs, {platform.machine()}, load {os.getloadavg()[0]:.1f}")
    rows = (row for place in places for row in _measured(place, options))
    return sizing_summary.show(json_lines.kept(rows, options.json))


def _places(options: argparse.Namespace) -> list[str]:
    """What is asked for by name: formulas, CAD faces, files with the small ones first."""
    files = []
    for path in options.paths:
        files += path.iterdir() if path.is_dir() else [path]
    formulas = [str(path) for path in files if path.suffix == ".toml"]
    files = [path for path in files if path.suffix.lower() in SUFFIXES]
    files.sort(key=lambda path: (path.stat().st_size, path.name))
    if options.quick:
        places = list(QUICK)
    else:
        names = [*_curved(), *FORMULAS]
        places = [FORMULA + name for name in names] + [SHAPE + name for name in SHAPES]
    places += [FORMULA + path for path in formulas] + [str(path) for path in files]
    if options.peers_only:
        places = [place for place in places if not place.startswith(FORMULA)]
    return [
        place for place in places
        if any(fnmatch(_name(place).removeprefix(SHAPE), pattern) for pattern in options.only)
    ]  # fmt: skip


def _curved() -> list[str]:
    """Of the gallery, what has a curvature to follow."""
    return [
        name for name in sm.gallery()
        if name != "plane" and isinstance(sm.load(name), ParametricSurface)
    ]  # fmt: skip


def _name(place: str) -> str:
    return place.removeprefix(FORMULA) if place.startswith(FORMULA) else Path(place).name


def _measured(place: str, options: argparse.Namespace) -> Iterator[dict]:
    """A row for each mesher, deviation and ratio of one input."""
    asked = {name: getattr(options, name) for name in ("deviations", "ratios", "most")}
    first = {"surface": _name(place)}
    if place.startswith(FORMULA):
        if "ours" in options.meshers:
            yield from _rows("ours", place, options, asked, first)
        return
    with tempfile.TemporaryDirectory(prefix="surfmesh-") as folder:
        truth = sizing_meshers.run("truth", place, options.time_limit, folder=folder)
        if "error" in truth:
            yield _said({**first, "mesher": "truth", "left_out": truth["error"]})
            return
        first |= {"faces_of_model": truth["faces"], "area_exact": truth["area"]}
        asked |= {"folder": folder, "diagonal": truth["diagonal"]}
        asked["max_size"] = LARGEST * truth["diagonal"]
        for mesher in options.meshers:
            yield from _rows(mesher, place, options, asked, first)


def _rows(
    mesher: str, place: str, options: argparse.Namespace, asked: dict, first: dict
) -> Iterator[dict]:
    found = sizing_meshers.run(mesher, place, options.time_limit, **asked)
    rows = found.get("rows", [])
    for row in rows:
        if "error" in found and row is rows[-1]:  # it ended in the middle of this one
            row["cut_short" if "triangles" in row else "left_out"] = found["error"]
        yield _said({**first, "mesher": mesher, **row})
    ratios = options.ratios if mesher == "ours" else [None]
    for share in options.deviations:
        for ratio in ratios:
            known = [row for row in rows if (row["share"], row.get("ratio")) == (share, ratio)]
            if not known:
                row = {**first, "mesher": mesher, "share": share}
                row["left_out"] = found.get("error", "no answer")
                yield _said(row if ratio is None else {**row, "ratio": ratio})


def _said(row: dict) -> dict:
    said = row.get("left_out") or f"{row.get('triangles', 0):,} triangles"
    asked = f"1/{row['share']:g}" if "share" in row else ""
    asked += f" ratio {row['ratio']:g}" if row.get("ratio") else ""
    console.print(
        f"{row['surface']} {row['mesher']} {asked}: {said}", markup=False, highlight=False
    )
    return row


def _options() -> argparse.Namespace:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("paths", nargs="*", type=Path, help="folders and files")
    parser.add_argument("--only", nargs="+", default=["*"], help="names, * and ? for any letters")
    parser.add_argument("--quick", action="store_true", help="a few surfaces, and the files")
    parser.add_argument("--peers-only", action="store_true", help="only what peers can read too")
    parser.add_argument("--meshers", default=",".join(MESHERS), help=f"some of {','.join(MESHERS)}")
    parser.add_argument("--ratios", nargs="+", type=float, default=[1.0, 5.0, 20.0, 100.0])
    parser.add_argument("--deviations", nargs="+", type=float, default=[1000.0, 10_000.0])
    parser.add_argument("--most", type=int, default=400_000, help="triangles; finer is left out")
    parser.add_argument("--time-limit", type=float, default=120.0, help="seconds for each mesher")
    parser.add_argument("--json", type=Path, help="one JSON object a line, as it comes")
    parser.add_argument("--summary", type=Path, help="show what an earlier run has found")
    options = parser.parse_args()
    options.meshers = options.meshers.split(",")
    if unknown := set(options.meshers) - set(MESHERS):
        parser.error(f"unknown meshers {sorted(unknown)}; known: {', '.join(MESHERS)}")
    if missing := [str(path) for path in options.paths if not path.exists()]:
        parser.error(f"there is no {missing[0]}")
    return options


if __name__ == "__main__":
    sys.exit(main())
