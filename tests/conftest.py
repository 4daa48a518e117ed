"""One way to run property tests, the corpus of CAD files, and small meshes with known answers.

Property tests try the same examples every time, so that main stays green;
``SURFMESH_FUZZ=2000 pytest tests/core`` looks for new ones, that many a test.
"""

import csv
import os
import sys
from pathlib import Path

import numpy as np
import pytest
from handmade_meshes import Saddle, grid
from hypothesis import HealthCheck, settings

from surfmesh.result.surface_mesh import SurfaceMesh

_CALM = {"deadline": None, "suppress_health_check": [HealthCheck.too_slow]}
_fuzz = os.environ.get("SURFMESH_FUZZ")

settings.register_profile("repeatable", derandomize=True, **_CALM)
settings.register_profile("fuzz", max_examples=int(_fuzz or 1), **_CALM)
settings.load_profile("fuzz" if _fuzz else "repeatable")


@pytest.fixture(scope="module")
def benchmarks_in_path():
    """For tests of the scripts in ``benchmarks/``, which import each other by name."""
    folder = str(Path(__file__).resolve().parents[1] / "benchmarks")
    sys.path.insert(0, folder)
    yield
    sys.path.remove(folder)


@pytest.fixture(scope="session")
def cad_folder() -> Path:
    """The folder of CAD files with their manifest.csv."""
    chosen = os.environ.get("SURFMESH_CAD_FOLDER")
    beside = Path(__file__).resolve().parents[2] / "shared" / "cad"
    folder = Path(chosen) if chosen else beside
    if not (folder / "manifest.csv").is_file():
        pytest.skip(f"no CAD files in {folder}; SURFMESH_CAD_FOLDER says where they are")
    return folder


@pytest.fixture(scope="session")
def cad_files(cad_folder) -> list[Path]:
    """Every file of the corpus."""
    with open(cad_folder / "manifest.csv", newline="") as file:
        return [cad_folder / row["file"] for row in csv.DictReader(file)]


@pytest.fixture
def tetrahedron():
    points = [(1, 1, 1), (1, -1, -1), (-1, 1, -1), (-1, -1, 1)]
    return SurfaceMesh(points=points, triangles=[(0, 1, 2), (0, 2, 3), (0, 3, 1), (1, 3, 2)])


@pytest.fixture
def saddle():
    return grid(
        Saddle(),
        8,
        sizes=np.full(81, 0.3),
        face_ids=np.repeat((0, 1), 64),
        surfaces=(Saddle(), Saddle()),
    )


@pytest.fixture
def moebius_band():
    """Seven triangles on seven vertices: t, t+1, t+2 modulo 7, which no orientation fits."""
    angle = 2 * np.pi * np.arange(7) / 7
    side = 0.3 * (-1.0) ** np.arange(7)  # in turns on either border of the band
    radius = 1 + side * np.cos(angle / 2)
    points = np.column_stack(
        (radius * np.cos(angle), radius * np.sin(angle), side * np.sin(angle / 2))
    )
    strip = [(t, t + 1, t + 2) if t % 2 == 0 else (t + 1, t, t + 2) for t in range(7)]
    return SurfaceMesh(points=points, triangles=np.array(strip) % 7)
