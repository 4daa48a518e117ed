"""The types of the compiled core, which mypy reads, are those of the core as it is."""

import subprocess
import sys
from pathlib import Path

import pytest

STUBS = Path(__file__).resolve().parents[2] / "surfmesh" / "_core"


def test_stubs_are_those_of_the_core(tmp_path):
    pytest.importorskip("nanobind", reason="nanobind, which makes them, is not installed")
    command = [sys.executable, "-m", "nanobind.stubgen", "-q", "-r", "-m", "surfmesh._core"]
    subprocess.run([*command, "-O", str(tmp_path)], check=True)
    made = {path.name: path.read_text() for path in (tmp_path / "_core").glob("*.pyi")}
    kept = {path.name: path.read_text() for path in STUBS.glob("*.pyi")}
    assert made == kept, "make stubs writes them anew"
