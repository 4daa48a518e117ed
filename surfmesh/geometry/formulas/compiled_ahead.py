"""Tapes of the gallery's formulas, made when the gallery is: SymPy takes 0.4 s to import.

They are looked up by all that they follow from, so that a formula that has been changed, or is
somebody's own, is compiled as ever. ``tools/compile_gallery.py`` makes the file; a test holds it
to what the compiler makes.
"""

from __future__ import annotations

import hashlib
import json
from collections.abc import Mapping, Sequence
from functools import cache
from pathlib import Path
from typing import Any, NamedTuple

from surfmesh.geometry.formulas.tape import Instruction, Tape
from surfmesh.geometry.surface import Domain

NAME = "compiled.json"
"""Of the file, in the folder of the gallery."""


class CompiledFormulas(NamedTuple):
    """What a surface of formulas needs of them: see the fields of ``ParametricSurface``."""

    domain: Domain
    root_places: tuple[list[float], list[float]]
    tapes: dict[int, Tape]

    def plain(self) -> dict[str, Any]:
        """As JSON has it."""
        tapes = {str(order): _plain(tape) for order, tape in sorted(self.tapes.items())}
        return {"domain": self.domain, "root_places": self.root_places, "tapes": tapes}

    @classmethod
    def of_plain(cls, plain: Mapping[str, Any]) -> CompiledFormulas:
        (u0, u1), (v0, v1) = plain["domain"]
        of_u, of_v = plain["root_places"]
        tapes = {int(order): _tape(tape) for order, tape in plain["tapes"].items()}
        return cls(((u0, u1), (v0, v1)), (of_u, of_v), tapes)


def key_of(formulas: Sequence[Any], bounds: Sequence[Any], parameters: Mapping[str, float]) -> str:
    """What compiled formulas are looked up by. Values are as a file has them: text and numbers."""
    said = json.dumps([list(formulas), [list(pair) for pair in bounds], dict(parameters)])
    return hashlib.sha256(said.encode()).hexdigest()


def compiled_ahead(folder: Path, key: str) -> CompiledFormulas | None:
    """What the file in a folder has under this key, if anything."""
    found = _known(folder).get(key)
    return None if found is None else CompiledFormulas.of_plain(found)


@cache
def _known(folder: Path) -> dict[str, Any]:
    try:
        return json.loads((folder / NAME).read_text(encoding="utf-8"))
    except OSError:  # a gallery without it
        return {}


def _plain(tape: Tape) -> list[Any]:
    steps = [[i.operation, i.target, list(i.operands), i.exponent] for i in tape.instructions]
    return [tape.inputs, list(tape.constants), steps, tape.registers, list(tape.outputs)]


def _tape(plain: Sequence[Any]) -> Tape:
    inputs, constants, steps, registers, outputs = plain
    instructions = tuple(Instruction(name, to, tuple(of), n) for name, to, of, n in steps)
    return Tape(inputs, tuple(constants), instructions, registers, tuple(outputs))
