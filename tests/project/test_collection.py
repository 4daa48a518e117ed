"""Any test file runs by itself, and any of them run together, in any order."""

import ast
import subprocess
import sys
from collections import Counter
from pathlib import Path

import pytest

TESTS = Path(__file__).resolve().parents[1]
BENCHMARKS = {path.stem for path in (TESTS.parent / "benchmarks").glob("*.py")}
FILES = {str(path.relative_to(TESTS)): path for path in sorted(TESTS.rglob("*.py"))}


def imported(path):
    """Names of the modules that a file imports, each up to its first dot."""
    for node in ast.walk(ast.parse(path.read_text(encoding="utf-8"))):
        if isinstance(node, ast.Import):
            yield from (alias.name.partition(".")[0] for alias in node.names)
        elif isinstance(node, ast.ImportFrom):
            assert node.level == 0, path
            yield node.module.partition(".")[0]


@pytest.mark.parametrize("name", FILES)
def test_a_file_needs_no_other_folder_of_tests(name):
    """The folder of a test is on the path when it runs; that of another test is not."""
    elsewhere = {path.stem for path in FILES.values() if path.parent != TESTS}
    found = set(imported(FILES[name]))
    assert found.isdisjoint(elsewhere | {"conftest"})
    if not found.isdisjoint(BENCHMARKS):  # which are on the path for those that say so
        assert "benchmarks_in_path" in FILES[name].read_text(encoding="utf-8")


def test_no_two_modules_have_one_name():
    names = Counter(path.stem for path in FILES.values() if path.name != "__init__.py")
    assert not [name for name, count in names.items() if count > 1]


def test_files_of_two_folders_are_collected():
    files = ["result/test_surface_mesh.py", "cad/model/test_pcurves.py", "view/test_lines.py"]
    command = [sys.executable, "-m", "pytest", "--collect-only", "-q", "-p", "no:cacheprovider"]
    paths = [str(TESTS / name) for name in files]
    run = subprocess.run(command + paths, cwd=TESTS.parent, capture_output=True, text=True)
    assert run.returncode == 0, run.stdout
