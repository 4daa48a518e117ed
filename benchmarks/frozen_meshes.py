"""What must not change while code is moved: the meshes of many inputs, to the last bit.

    python benchmarks/frozen_meshes.py --write BEFORE.json [--folder FOLDER] [--only PATTERN ...]
    python benchmarks/frozen_meshes.py --compare BEFORE.json [--folder FOLDER] [--only PATTERN ...]

Inputs: the gallery, CadQuery parts, planar domains and the CAD files of a folder, each isotropic
and stretched. A mesh is its ``mesh_sha256`` and its number of triangles, a refusal is its message.
The file is written after each input, so that a run that is cut short can be continued. Exits with
1 when something differs; processor and versions have to be the same.
"""

import single_thread  # noqa: F401  (before numpy)

# isort: split
import argparse
import json
import sys
from collections.abc import Iterator
from fnmatch import fnmatch
from pathlib import Path
from typing import Any

import child_process
from cad_parts import PARTS
from frozen_inputs import DOMAINS
from tables import console, heading

from surfmesh.cad.reading.read_file import SUFFIXES
from surfmesh.geometry.files.surface_file import gallery

NOT_THE_SAME = {"shelled_box"}  # OpenCASCADE makes another shell in every process
TIME_LIMIT = 90.0  # seconds a mesh; what takes longer is left out


def main() -> int:
    options = _options()
    known: dict[str, dict] = {}
    if options.write and options.write.exists():
        known = json.loads(options.write.read_text(encoding="utf-8"))
    before = json.loads(options.compare.read_text(encoding="utf-8")) if options.compare else {}
    heading("meshes that must not change")
    changed = tried = 0
    for name, request in _inputs(options.folder):
        if options.only and not any(fnmatch(name, pattern) for pattern in options.only):
            continue
        if name in known or (options.compare and name not in before):
            continue
        found = child_process.run("frozen_inputs.py", request, options.time_limit)
        tried += 1
        if options.compare:
            changed += not _same(name, before[name], found)
        if options.write:
            known[name] = found
            options.write.write_text(json.dumps(known, indent=1) + "\n", encoding="utf-8")
            console.print(f"  {name}: {_said(found)}")
    if options.compare:
        console.print(f"{tried} compared, {changed} changed")
    return 1 if changed else 0


def _same(name: str, before: dict, now: dict) -> bool:
    """Whether nothing has changed; says what has. What ran out of time tells nothing."""
    if "hang" in (before.get("ended"), now.get("ended")):
        console.print(f"  {name}: not done in time ({_said(before)} -> {_said(now)})")
        return True
    same = all(before.get(key) == now.get(key) for key in ("sha256", "triangles", "error"))
    if not same:
        console.print(f"  {name}: {_said(before)} -> {_said(now)}")
    return same


def _said(found: dict) -> str:
    if "error" in found:
        return str(found["error"])
    return f"{found['triangles']} triangles, {found['sha256'][:12]}"


def _inputs(folder: Path | None) -> Iterator[tuple[str, dict[str, Any]]]:
    """Names of inputs, and what the child is asked for."""
    for name in gallery():
        for way in ("default", "coarse", "stretched"):
            yield f"gallery/{name}/{way}", {"gallery": name, "way": way}
    for name in DOMAINS:
        yield f"domain/{name}", {"domain": name, "way": "default"}
    for name in sorted(PARTS.keys() - NOT_THE_SAME):
        for way in ("coarse", "stretched"):
            yield f"part/{name}/{way}", {"part": name, "way": way}
    places = sorted(folder.iterdir()) if folder else []
    for place in places:
        if place.suffix.lower() in SUFFIXES:
            for way in ("coarse", "stretched"):
                yield f"file/{place.name}/{way}", {"file": str(place), "way": way}


def _options() -> argparse.Namespace:
    parser = argparse.ArgumentParser(description=(__doc__ or "").splitlines()[0])
    what = parser.add_mutually_exclusive_group(required=True)
    what.add_argument("--write", type=Path)
    what.add_argument("--compare", type=Path)
    parser.add_argument("--folder", type=Path, help="CAD files")
    parser.add_argument("--only", nargs="*", default=[])
    parser.add_argument("--time-limit", type=float, default=TIME_LIMIT)
    return parser.parse_args()


if __name__ == "__main__":
    sys.exit(main())
