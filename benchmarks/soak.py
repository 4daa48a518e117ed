"""Many small meshes of all kinds in one process: does its memory grow?

    python benchmarks/soak.py [--count 1000]

Each is made, checked, written in one of the formats and read again; every tenth has its page
written, every twentieth comes from a CAD file, and some inputs are refused on purpose. What the
first 200 leave behind (caches, imported modules) is not growth.
"""

import single_thread  # noqa: F401  (before numpy)

# isort: split
import argparse
import contextlib
import gc
import json
import sys
import tempfile
import warnings
from collections.abc import Callable
from pathlib import Path
from typing import Any

import cadquery as cq
import numpy as np

import surfmesh as sm
from surfmesh.errors import SurfmeshError
from surfmesh.io import FORMATS, read

FIRST = 200  # meshes that fill the caches
EVERY = 10  # meshes between two looks at the memory
GROWTH = 1.0  # MB in a hundred meshes that are within what the allocator moves


def soak(
    count: int, told: Callable[[int, float], None] = lambda number, megabytes: None
) -> dict[str, float | bool]:
    """Megabytes held after ``FIRST`` meshes and at the end, and the growth in a hundred.

    told: is called with the number of meshes so far and the megabytes. The growth is the slope
    of a line through all figures after the first.
    """
    held = []
    with tempfile.TemporaryDirectory() as folder, warnings.catch_warnings():
        warnings.simplefilter("ignore", UserWarning)  # of corners alone for order 2
        for number in range(count):
            _one(number, Path(folder))
            if number % EVERY == EVERY - 1:
                gc.collect()
                held.append((number + 1, resident_megabytes()))
                told(*held[-1])
    later = np.array([entry for entry in held if entry[0] >= min(FIRST, count // 2)])
    slope = float(np.polyfit(later[:, 0], later[:, 1], 1)[0]) if len(later) > 1 else 0.0
    return {
        "meshes": count,
        "megabytes_after_the_first": float(later[0, 1]),
        "megabytes_at_the_end": float(later[-1, 1]),
        "growth_in_a_hundred": 100 * slope,
        "grows": 100 * slope > GROWTH,
    }


def resident_megabytes() -> float:
    import psutil

    return psutil.Process().memory_info().rss / 2**20


def _one(number: int, folder: Path) -> None:
    """Make, check, write, read; the kinds take turns."""
    order = 1 + (number % 3 == 2)
    mesh = sm.mesh(_thing(number, folder), _sizes(number), order=order, strict=False)
    report = sm.check(mesh)
    report.to_json()
    extension = [*FORMATS][number % len(FORMATS)]
    read(mesh.save(folder / f"soak{extension}"))
    if number % 10 == 0:
        sm.view.html_report(mesh, folder / "soak.html", report=report)
    for wrong in (folder / "none.vtu", folder / "soak.html"):
        with contextlib.suppress(SurfmeshError):
            read(wrong)
    with contextlib.suppress(SurfmeshError):
        sm.mesh(sm.load("plane"), sm.Sizing(size=0.001, limit=100))


def _thing(number: int, folder: Path) -> Any:
    names = ("torus", "wavy", "mobius", "klein", "pierced_saddle", "floor_plate", "cone", "sphere")
    if number % 20 == 7:
        path = folder / "part.step"
        cq.exporters.export(_part(number), str(path))
        return sm.load(path)
    if number % 4 == 1:
        return sm.from_cadquery(_part(number))
    if number % 4 == 3:
        bend = 1 + number / 1000  # a formula of its own each time
        return sm.ParametricSurface("u", "v", f"sin({bend}*u)*v/4", u=(0, 1), v=(0, 1))
    return sm.load(names[(number // 2) % len(names)])


def _part(number: int) -> cq.Workplane:
    width = 1 + number % 5
    return cq.Workplane().box(width, 2, 1).faces(">Z").hole(0.5).edges("|Z").fillet(0.1)


def _sizes(number: int) -> sm.Sizing:
    return sm.Sizing(angle=40, growth=1.5, anisotropy=3.0 if number % 5 == 4 else 1.0)


def _tell(number: int, megabytes: float) -> None:
    if number % 100 == 0:
        print(f"{number} meshes: {megabytes:.1f} MB", file=sys.stderr, flush=True)


if __name__ == "__main__":
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--count", type=int, default=1000)
    print(json.dumps(soak(parser.parse_args().count, _tell)))
