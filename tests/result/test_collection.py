"""Any test files run together, in any order."""

import ast
import subprocess
import sys
from collections import Counter
from pathlib import Path

import pytest

TESTS = Path(__file__).resolve().parents[1]


def test_no_module_imports_a_conftest():
    for path in TESTS.rglob("*.py"):
        for node in ast.walk(ast.parse(path.read_text())):
            names = [node.module] if isinstance(node, ast.ImportFrom) else []
            names += [alias.name for alias in node.names] if isinstance(node, ast.Import) else []
            assert "conftest" not in names, path


def test_no_two_modules_have_one_name():
    paths = [path for path in TESTS.rglob("*.py") if path.parent.name != "naive"]
    names = Counter(path.stem for path in paths if path.name != "conftest.py")
    assert not [name for name, count in names.items() if count > 1]


@pytest.mark.parametrize(
    "pair",
    [("result/test_surface_mesh.py", "cad/test_euler.py"),
     ("cad/test_pcurves.py", "result/test_lines.py")],
)  # fmt: skip
def test_files_of_two_folders_are_collected(pair):
    files = [str(TESTS / name) for name in pair]
    command = [sys.executable, "-m", "pytest", "--collect-only", "-q", "-p", "no:cacheprovider"]
    run = subprocess.run(command + files, cwd=TESTS.parent, capture_output=True, text=True)
    assert run.returncode == 0, run.stdout
