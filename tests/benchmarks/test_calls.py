"""Benchmarks, which no test runs, call functions of surfmesh with arguments that these take."""

import ast
import importlib
import inspect
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest

FILES = sorted((Path(__file__).parents[2] / "benchmarks").glob("*.py"))


def of_surfmesh(tree: ast.AST) -> dict[str, Any]:
    """What a module imports of surfmesh, under the names it has there."""
    found = {}
    for node in ast.walk(tree):
        if isinstance(node, ast.Import):
            for name in node.names:
                if name.name.split(".")[0] == "surfmesh" and name.asname:
                    found[name.asname] = importlib.import_module(name.name)
        elif isinstance(node, ast.ImportFrom) and (node.module or "").split(".")[0] == "surfmesh":
            home = importlib.import_module(node.module)
            for name in node.names:
                if not hasattr(home, name.name):
                    importlib.import_module(f"{node.module}.{name.name}")
                found[name.asname or name.name] = getattr(home, name.name)
    return found


def calls(tree: ast.AST, known: dict[str, Any]) -> Iterator[tuple[ast.Call, Any]]:
    """Calls of what is known, by name or as an attribute of a module, with all arguments seen."""
    for node in ast.walk(tree):
        if not isinstance(node, ast.Call):
            continue
        if any(isinstance(a, ast.Starred) for a in node.args) or any(
            k.arg is None for k in node.keywords
        ):
            continue
        match node.func:
            case ast.Name(id=name) if name in known:
                yield node, known[name]
            case ast.Attribute(value=ast.Name(id=name), attr=attribute) if inspect.ismodule(
                known.get(name)
            ):
                yield node, getattr(known[name], attribute)


@pytest.mark.parametrize("path", FILES, ids=lambda path: path.stem)
def test_calls_fit(path):
    tree = ast.parse(path.read_text())
    for call, called in calls(tree, of_surfmesh(tree)):
        try:
            signature = inspect.signature(called)
        except ValueError:  # of the compiled core: it has none
            continue
        try:
            signature.bind(*call.args, **{k.arg: k.value for k in call.keywords})
        except TypeError as error:
            pytest.fail(f"line {call.lineno}: {ast.unparse(call)}: {error}")
