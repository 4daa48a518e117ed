"""Do trimesh and PyVista see what the report says? Over the gallery, and a folder of CAD files.

    python benchmarks/second_opinion.py [FOLDER] [--limit SECONDS] [--all]

Every surface is meshed with its own sizes, every file with those that surfmesh takes for it. The
exit status is 1 when there is a disagreement.
"""

import argparse
import sys
from collections import Counter
from pathlib import Path

from child_process import run

from surfmesh.cad.reading.read_file import SUFFIXES
from surfmesh.geometry.files.surface_file import gallery


def main() -> int:
    """Print a line for each, then the figure."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("folder", nargs="?", type=Path, help="of STEP, IGES and BREP files")
    parser.add_argument("--limit", type=float, default=60.0, help="seconds for each (default 60)")
    parser.add_argument("--all", action="store_true", help="list what is not compared, too")
    options = parser.parse_args()
    whole = Counter()
    for what in [*gallery(), *_files(options.folder)]:
        found = run("opinion_of_one.py", {"what": str(what)}, options.limit)
        _print(Path(what).name, found, options.all)
        whole["left out"] += "error" in found
        if "error" not in found:
            whole.update(meshes=1, compared=found["compared"], disagreements=len(found["rows"]))
    print(
        f"{whole['meshes']} meshes, {whole['left out']} left out, {whole['compared']:,} figures "
        f"compared, disagreements {whole['disagreements']}"
    )
    return whole["disagreements"] > 0


def _files(folder: Path | None) -> list[Path]:
    if folder is None:
        return []
    return sorted(path for path in folder.iterdir() if path.suffix.lower() in SUFFIXES)


def _print(name: str, found: dict, everything: bool) -> None:
    if "error" in found:
        print(f"{name:<48} left out: {found['error']}", flush=True)
        return
    print(
        f"{name:<48} {found['triangles']:>9,} triangles {found['solids']:>4} solids "
        f"{found['agreed']:>5} of {found['compared']:>5} agree, {found['seconds']:6.2f} s "
        f"(check {found['check']:.2f} s)",
        flush=True,
    )
    for line in found["rows"] + (found["left"] if everything else []):
        print(f"    {line}")


if __name__ == "__main__":
    sys.exit(main())
