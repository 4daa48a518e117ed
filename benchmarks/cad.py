"""CAD files one by one: closed? true? well shaped? how fast?

    python benchmarks/cad.py FOLDER_OR_FILES... [--most-faces 400]

One line a file: open edges, edges of three triangles and more, errors of area and volume,
deviation over chord, alpha, seconds for reading and meshing, faces that could not be meshed.
"""

import argparse
from pathlib import Path
from time import perf_counter

import surfmesh as sm
from surfmesh.cad.reading import SUFFIXES
from surfmesh.errors import SurfmeshError
from surfmesh.surface_mesh import NOT_MESHED


def line(path: Path, most_faces: int) -> str:
    """What there is to say of one file."""
    start = perf_counter()
    model = sm.load(path)
    read = perf_counter()
    if len(model.faces) > most_faces:
        return f"{len(model.faces)} faces: left out"
    mesh = sm.mesh(model, strict=False)
    done = perf_counter()
    report = sm.check(mesh)
    uses = mesh.connectivity.uses
    volume = "-"
    if report.volume and model.volume:
        volume = f"{report.volume / model.volume - 1:.1e}"
    failed = [text for text in mesh.warnings if text.startswith(NOT_MESHED)]
    return (
        f"faces {len(model.faces)} solids {len(model.solids)} triangles {len(mesh.triangles)} "
        f"open {(uses == 1).sum()} crowded {(uses > 2).sum()} euler {report.euler} "
        f"area {report.area / model.area - 1:.1e} volume {volume} "
        f"deviation/chord {report.deviation_max / mesh.sizing.chord:.2f} "
        f"alpha {report.alpha_mean:.3f} {report.alpha_min:.3f} "
        f"read {read - start:.1f} s mesh {done - read:.1f} s failed {len(failed)} {failed[:1]}"
    )


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("paths", nargs="+", type=Path)
    parser.add_argument("--most-faces", type=int, default=400)
    options = parser.parse_args()
    files = []
    for path in options.paths:
        files += sorted(path.iterdir()) if path.is_dir() else [path]
    for path in files:
        if path.suffix.lower() not in SUFFIXES:
            continue
        try:
            print(path.name, line(path, options.most_faces), flush=True)
        except SurfmeshError as error:
            print(path.name, type(error).__name__, error, flush=True)


if __name__ == "__main__":
    main()
