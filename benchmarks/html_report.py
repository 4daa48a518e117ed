"""Size of the HTML report, and how long it takes to write and to open in headless Chromium.

    python benchmarks/html_report.py [--triangles 20000 200000] [--input part.step]

Without a browser, or without playwright, only size and writing are measured. The browser draws
in software, as it has no graphics card here.
"""

import argparse
import math
import os
import shutil
import tempfile
from pathlib import Path
from time import perf_counter

from rich.box import SIMPLE_HEAD
from rich.table import Table
from tables import console, heading

import surfmesh as sm
from surfmesh.view import html_report

LARGEST = 15e6
"""Bytes wanted for 200 thousand triangles, at most."""


def seconds_to_open(path: Path) -> float | None:
    """From the address to a page that says it is ready."""
    names = os.environ.get("SURFMESH_BROWSER", ""), "chromium", "chromium-browser", "google-chrome"
    browser = next((found for name in names if name and (found := shutil.which(name))), None)
    try:
        from playwright.sync_api import sync_playwright
    except ImportError:
        return None
    if browser is None:
        return None
    software = ["--no-sandbox", "--use-gl=angle", "--use-angle=swiftshader"]
    with sync_playwright() as running:
        launched = running.chromium.launch(executable_path=browser, args=software)
        page = launched.new_page()
        start = perf_counter()
        page.goto(path.as_uri())
        page.wait_for_selector("html[data-ready=yes]", timeout=120_000)
        taken = perf_counter() - start
        launched.close()
    return taken


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--triangles", nargs="+", type=int, default=[20_000, 200_000])
    parser.add_argument("--input", type=Path, help="a CAD file, at its default sizes")
    options = parser.parse_args()
    meshes = {}
    if options.input:
        meshes[options.input.name] = sm.mesh(sm.load(options.input), strict=False)
    for count in options.triangles:  # of the unit sphere: area 4 pi
        size = math.sqrt(4.0 * math.pi / count * 4.0 / math.sqrt(3.0))
        meshes[f"sphere {count:,}"] = sm.mesh(sm.load("sphere"), size)
    heading("The HTML report")
    table = Table(box=SIMPLE_HEAD)
    for title in ("", "triangles", "MB", "MB for 200 thousand", "written, s", "opened, s"):
        table.add_column(title, justify="right")
    missed = False
    with tempfile.TemporaryDirectory() as folder:
        for name, mesh in meshes.items():
            start = perf_counter()
            path = html_report(mesh, Path(folder) / "report.html", name=name)
            written = perf_counter() - start
            size, count = path.stat().st_size, len(mesh.triangles)
            scaled = size * max(1.0, 200_000 / count)
            missed |= count >= 200_000 and size * 200_000 / count > LARGEST
            opened = seconds_to_open(path)
            table.add_row(
                name, f"{count:,}", f"{size / 1e6:.2f}", f"{scaled / 1e6:.1f} at most",
                f"{written:.1f}", "no browser" if opened is None else f"{opened:.1f}",
            )  # fmt: skip
    console.print(table)
    raise SystemExit(int(missed))


if __name__ == "__main__":
    main()
