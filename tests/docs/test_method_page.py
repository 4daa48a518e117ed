"""docs/method.md shows functions of the reference and of its twins: as they are there."""

import ast
import inspect
import re
import textwrap
from pathlib import Path

import pytest
from naive.random_packing import RandomPacking

from surfmesh.reference import boundary_insertion
from surfmesh.reference.field_packing import FieldPacking
from surfmesh.reference.plane_triangulation import Triangulation

PAGE = Path(__file__).resolve().parents[2] / "docs" / "method.md"
HOMES = (boundary_insertion, Triangulation, FieldPacking, RandomPacking)


def shown():
    text = PAGE.read_text(encoding="utf-8")
    for code in re.findall(r"^```python\n(.*?)^```$", text, re.MULTILINE | re.DOTALL):
        for node in ast.parse(code).body:
            if isinstance(node, ast.FunctionDef):
                yield node.name, ast.get_source_segment(code, node)


SHOWN = list(shown())


@pytest.mark.parametrize("name, code", SHOWN, ids=[name for name, _ in SHOWN])
def test_a_function_is_shown_as_it_is(name, code):
    sources = [
        textwrap.dedent(inspect.getsource(vars(home)[name])).rstrip()
        for home in HOMES
        if name in vars(home)
    ]
    assert code in sources


def test_the_main_steps_are_shown():
    names = {name for name, _ in SHOWN}
    assert {"fit_to_two", "touch_three", "push_out", "advance", "insert_boundary"} <= names
