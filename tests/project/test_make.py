"""What `make` installs, as it would do it: without a run."""

import re
import shutil
import subprocess
from pathlib import Path

import pytest

HERE = Path(__file__).resolve().parents[2]
MAKE = shutil.which("make")


@pytest.mark.skipif(MAKE is None, reason="there is no make")
@pytest.mark.parametrize(
    ("target", "requirement"),
    [("venv", ".[cad,view]"), ("lint", ".[dev]"), ("bench", ".[bench]"), ("lowest", ".[test]")],
)
def test_each_target_installs_its_extras(tmp_path, target, requirement):
    commands = subprocess.run(
        [str(MAKE), "-n", target, f"VENV={tmp_path / 'env'}", f"LOWEST={tmp_path / 'lowest'}"],
        cwd=HERE, capture_output=True, text=True, check=True,
    ).stdout  # fmt: skip
    installed = set(re.findall(r"-e '([^']+)'", commands))
    assert installed == {requirement}
