"""How far the sizes of meshes keep to ``growth``: fraction of edges beyond it, and the largest.

    python benchmarks/gradation.py                    the gallery, isotropic and stretched
    python benchmarks/gradation.py wavy part.step     these surfaces and files alone

Along an edge of length l the sizes wanted at its two ends may differ by slope l, the slope that
``growth`` stands for. Counted are edges where they differ by more than a tenth more.
"""

import single_thread  # noqa: F401  (before numpy)

# isort: split
import argparse
import time
from collections.abc import Iterator
from pathlib import Path

import surfmesh as sm
from surfmesh.errors import SurfmeshError
from surfmesh.quality.measures.lengths import edge_figures

SIZINGS = {"isotropic": {}, "stretched": {"anisotropy": 8.0}}


def meshes(names: list[str]) -> Iterator[tuple[str, str, sm.SurfaceMesh, float]]:
    """Name, kind of sizes, mesh and processor seconds."""
    for name in names or [*sm.gallery()]:
        for kind, asked in SIZINGS.items():
            start = time.process_time()
            try:
                mesh = sm.mesh(sm.load(name), sm.Sizing(**asked))
            except SurfmeshError as error:
                print(f"{Path(name).name:24} {kind:10} {error}")
                continue
            yield Path(name).name, kind, mesh, time.process_time() - start


def beyond_growth(mesh: sm.SurfaceMesh, growth: float) -> tuple[float, float]:
    """Fraction of the edges beyond 1.1 times what ``growth`` allows, and the largest growth, 1
    where it is what is allowed."""
    slope = 2.0 * (growth - 1.0) / (growth + 1.0)
    _, largest, beyond = edge_figures(mesh, slope=slope).changes
    return beyond / len(mesh.edges), largest


def main() -> None:
    parser = argparse.ArgumentParser(description="How far meshes keep to growth.")
    parser.add_argument("names", nargs="*", help="surfaces of the gallery, or files")
    print(
        f"{'surface':24} {'sizes':10} {'triangles':>9} {'beyond':>8} {'largest':>8} {'seconds':>8}"
    )
    for name, kind, mesh, seconds in meshes(parser.parse_args().names):
        fraction, largest = beyond_growth(mesh, sm.Sizing().growth)
        print(
            f"{name:24} {kind:10} {len(mesh.triangles):9,} {100 * fraction:6.2f} % {largest:8.3f} "
            f"{seconds:8.2f}"
        )


if __name__ == "__main__":
    main()
