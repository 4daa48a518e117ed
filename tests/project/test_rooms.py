"""Each room of the package names its modules once, in its docstring, and names nothing else."""

import ast
import re
from collections import Counter
from pathlib import Path

import pytest

PACKAGE = Path(__file__).resolve().parents[2] / "surfmesh"
ROOMS = [path.parent for path in sorted(PACKAGE.glob("*/**/__init__.py"))]
NAMED = re.compile(r"^([a-z_0-9]+(?:, [a-z_0-9]+)*)(?:: | {2,})", re.MULTILINE)


def children(room):
    """Modules and rooms in a room."""
    modules = {path.stem for path in room.glob("*.py")} - {"__init__"}
    return modules | {path.parent.name for path in room.glob("*/__init__.py")}


@pytest.mark.parametrize("room", ROOMS, ids=lambda room: str(room.relative_to(PACKAGE)))
def test_a_room_names_each_of_its_modules_once(room):
    said = ast.get_docstring(ast.parse((room / "__init__.py").read_text(encoding="utf-8"))) or ""
    names = Counter(name for line in NAMED.findall(said) for name in line.split(", "))
    assert set(names) == children(room)
    assert max(names.values()) == 1
