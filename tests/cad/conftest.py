"""The corpus of CAD files, which lies beside the repository or where the user says."""

import csv
import os
from pathlib import Path

import pytest


@pytest.fixture(scope="session")
def cad_folder() -> Path:
    """The folder of CAD files with their manifest.csv."""
    chosen = os.environ.get("SURFMESH_CAD_FOLDER")
    beside = Path(__file__).resolve().parents[3] / "shared" / "cad"
    folder = Path(chosen) if chosen else beside
    if not (folder / "manifest.csv").is_file():
        pytest.skip(f"no CAD files in {folder}; SURFMESH_CAD_FOLDER says where they are")
    return folder


@pytest.fixture(scope="session")
def cad_files(cad_folder) -> list[Path]:
    """Every file of the corpus."""
    with open(cad_folder / "manifest.csv", newline="") as file:
        return [cad_folder / row["file"] for row in csv.DictReader(file)]
