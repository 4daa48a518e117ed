"""CadQuery's string selectors, evaluated on a plain model.

    >Z <X    farthest along a direction, by the centre of mass        >>Z[1] the second of them
    >Z[1]    likewise among plane faces and straight edges across, along the direction
    |Z #Z    plane faces with a normal along Z, at right angles to it; straight edges alike
    +Z -Z    the normal or the edge points that way
    %CYLINDER  kind of surface or curve
    and, or, exc (except), not, brackets; directions X, XY, (1,0,2); front, top, ...

Precedence is that of CadQuery: "and", then "or", then "exc", then "not".
"""

from __future__ import annotations

import math
import re
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from typing import NoReturn

import numpy as np

from surfmesh.cad.model.cad_model import CadEdge, CadFace, CadModel, CadSolid, CadVertex
from surfmesh.cad.model.centres import edge_centre, face_centre, solid_centre
from surfmesh.errors import SizingError
from surfmesh.geometry.number_range import RANGE
from surfmesh.geometry.small_matrices import norm, product

TOLERANCE = 1e-4
"""As CadQuery has it: radians and lengths alike; lengths at least SPREAD of the diagonal."""

SPREAD = 1e-6

Item = CadFace | CadEdge | CadVertex | CadSolid

KINDS = ("face", "edge", "vertex", "solid")

LONGEST, DEEPEST = 2000, 50
"""Characters of a selector, and brackets or words "not" within each other."""

_AXES = {
    "X": (1, 0, 0), "Y": (0, 1, 0), "Z": (0, 0, 1), "XY": (1, 1, 0), "XZ": (1, 0, 1),
    "YZ": (0, 1, 1),
}  # fmt: skip
_VIEWS = {
    "front": ">Z", "back": "<Z", "left": "<X", "right": ">X", "top": ">Y", "bottom": "<Y",
}  # fmt: skip
_NUMBER = r"[+-]?\d+(?:\.\d*)?"
_DIRECTION = rf"(?:XY|XZ|YZ|X|Y|Z|\(\s*{_NUMBER}\s*,\s*{_NUMBER}\s*,\s*{_NUMBER}\s*\))"
_ATOM = re.compile(
    rf"\s*(?:%\s*(?P<kind>[A-Za-z]+)"
    rf"|(?P<far>>>|<<|>|<)\s*(?P<along>{_DIRECTION})\s*(?:\[\s*(?P<index>-?\d+)\s*\])?"
    rf"|(?P<turn>[|#+-]?)\s*(?P<axis>{_DIRECTION})"
    rf"|(?P<view>front|back|left|right|top|bottom)\b)"
)
_WORD = re.compile(r"\s*(and|or|exc|except|not|\(|\))(?![A-Za-z])")
_LOOKS = re.compile(r"^\s*(?:not\b|\(*\s*(?:[|#+%]|-\s*[XYZ(]|[<>]))")


def is_selector(text: str) -> bool:
    """Does it look like one of CadQuery's selectors, and not like a name?"""
    return bool(_LOOKS.match(text))


def selected(model: CadModel, kind: str, text: str) -> list[int]:
    """Numbers of the faces, edges, vertices or solids that a selector finds.

    kind: one of KINDS. Raises ``SizingError`` with the column of what is not understood.
    """
    if len(text) > LONGEST:
        raise SizingError(
            f"selector {text[:40]!r}...: it has {len(text):,} characters, more than {LONGEST:,}"
        )
    things = _Things(model, kind)
    parser = _Parser(things, text)
    found = parser.expression()
    parser.expect_end()
    return sorted(found)


class _Things:
    """What selectors ask about the faces, edges, vertices or solids of a model."""

    def __init__(self, model: CadModel, kind: str) -> None:
        self.model = model
        of: dict[str, Sequence[Item]] = {
            "face": model.faces, "edge": model.edges, "vertex": model.vertices,
            "solid": model.solids,
        }  # fmt: skip
        self.items = of[kind]
        self.all = {
            k for k, item in enumerate(self.items)
            if not (isinstance(item, CadEdge) and item.degenerate)
        }  # fmt: skip
        self.tolerance = max(TOLERANCE, SPREAD * model.diagonal)
        self._against = {
            number: flag for solid in model.solids for shell in solid.shells
            for number, flag in shell
        }  # fmt: skip
        self._centres: dict[int, np.ndarray] = {}
        self._directions: dict[int, np.ndarray | None] = {}

    def centre(self, number: int) -> np.ndarray:
        if number not in self._centres:
            self._centres[number] = self._centre(self.items[number])
        return self._centres[number]

    def _centre(self, item: Item) -> np.ndarray:
        if isinstance(item, CadFace):
            return face_centre(item)
        if isinstance(item, CadEdge):
            return edge_centre(item)
        return item.point if isinstance(item, CadVertex) else solid_centre(self.model, item)

    def direction(self, number: int) -> np.ndarray | None:
        """Normal (3,) of a plane face, out of its solid; tangent of a straight edge."""
        if number not in self._directions:
            self._directions[number] = self._direction(number)
        return self._directions[number]

    def _direction(self, number: int) -> np.ndarray | None:
        item = self.items[number]
        if isinstance(item, CadFace) and item.kind == "plane":
            (u0, u1), (v0, v1) = item.surface.domain
            middle = np.array([[0.5 * (u0 + u1), 0.5 * (v0 + v1)]])
            _, r_u, r_v = item.surface.evaluate(middle, 1)
            normal = np.cross(r_u[0], r_v[0]) / norm(np.cross(r_u[0], r_v[0]))
            return -normal if item.reversed != self._against.get(number, False) else normal
        if isinstance(item, CadEdge) and item.is_straight:
            _, tangent = item.evaluate(np.array([0.5]), 1)
            return tangent[0] / norm(tangent[0])
        return None

    def of_kind(self, name: str) -> set[int]:
        kinds = {k: _kind(self.items[k]) for k in self.all}
        return {k for k, kind in kinds.items() if kind == name.lower()}

    def turned(self, fits: Callable[[np.ndarray], bool]) -> set[int]:
        """Those with a direction (3,) that ``fits``."""
        directions = {k: self.direction(k) for k in self.all}
        return {k for k, d in directions.items() if d is not None and fits(d)}

    def nth(self, among: set[int], along: np.ndarray, index: int, rising: bool) -> set[int]:
        """The index-th group of equal distance along a direction."""
        if not among:
            return set()
        order = sorted((float(product(self.centre(k), along)), k) for k in among)
        groups: list[list[int]] = [[]]
        start = order[0][0]
        for key, number in order:
            if abs(key - start) > self.tolerance:
                groups.append([])
                start = key
            groups[-1].append(number)
        if not rising:
            groups.reverse()
        return set(groups[index]) if -len(groups) <= index < len(groups) else set()


class _Parser:
    """Recursive descent, one method a level of precedence."""

    def __init__(self, things: _Things, text: str) -> None:
        self.things, self.text, self.at = things, text, 0
        self.depth = 0

    def expression(self) -> set[int]:
        if self._word("not"):
            with self._deeper():
                return self.things.all - self.expression()
        return self._chain(self._any, ("exc", "except"), lambda a, b: a - b)

    def _any(self) -> set[int]:
        return self._chain(self._every, ("or",), lambda a, b: a | b)

    def _every(self) -> set[int]:
        return self._chain(self._term, ("and",), lambda a, b: a & b)

    def _chain(
        self, part: Callable[[], set[int]], words: Sequence[str],
        join: Callable[[set[int], set[int]], set[int]],
    ) -> set[int]:  # fmt: skip
        found = part()
        while self._word(*words):
            found = join(found, part())
        return found

    def _term(self) -> set[int]:
        atom = _ATOM.match(self.text, self.at)
        if atom:
            self.at = atom.end()
            return self._atom(atom)
        if self._word("not"):
            with self._deeper():
                return self.things.all - self._term()
        if self._word("("):
            with self._deeper():
                found = self.expression()
            if not self._word(")"):
                self._fail("a closing bracket is missing")
            return found
        self._fail("this is no selector of CadQuery")

    @contextmanager
    def _deeper(self) -> Iterator[None]:
        self.depth += 1
        if self.depth > DEEPEST:
            self._fail(f"more than {DEEPEST} brackets or words 'not' within each other")
        yield
        self.depth -= 1

    def _atom(self, atom: re.Match) -> set[int]:
        things = self.things
        if atom["view"]:
            return selected_set(things, _VIEWS[atom["view"]])
        if atom["kind"]:
            return things.of_kind(atom["kind"])
        if atom["far"]:
            along = self._along(atom["along"])
            among, index = things.all, -1
            if atom["index"] is not None:
                index = int(atom["index"][:18])  # no model has as many
                if len(atom["far"]) == 1:
                    among = things.turned(lambda d: _sine(along, d) < TOLERANCE)
            return things.nth(among, along, index, atom["far"][0] == ">")
        axis = self._along(atom["axis"])
        if atom["turn"] == "|":
            return things.turned(lambda d: _sine(axis, d) < TOLERANCE)
        if atom["turn"] == "#":
            return things.turned(lambda d: abs(_angle(axis, d) - 0.5 * math.pi) < TOLERANCE)
        axis = -axis if atom["turn"] == "-" else axis
        return things.turned(lambda d: _angle(axis, d) < TOLERANCE)

    def _along(self, text: str) -> np.ndarray:
        direction = _direction(text)
        length = np.abs(direction).max()
        if not (1.0 / RANGE.square < length < RANGE.square):
            self._fail(f"{text:.60} is no direction")
        return direction

    def expect_end(self) -> None:
        if self.text[self.at :].strip():
            self._fail("this is no selector of CadQuery")

    def _word(self, *words: str) -> bool:
        found = _WORD.match(self.text, self.at)
        if found and found[1] in words:
            self.at = found.end()
            return True
        return False

    def _fail(self, reason: str) -> NoReturn:
        rest = self.text[self.at :].strip()
        raise SizingError(
            f"selector {self.text!r:.200}: {reason} (column {self.at + 1}"
            + (f", at {rest[:20]!r})" if rest else ", at its end)")
        )


def selected_set(things: _Things, text: str) -> set[int]:
    """What a selector without operators finds."""
    return _Parser(things, text).expression()


def _kind(item: Item) -> str:
    """As CadQuery calls it, in small letters; "" of what has no kind."""
    if isinstance(item, CadEdge):
        return "" if item.curve is None else item.curve.kind
    return item.kind if isinstance(item, CadFace) else ""


def _direction(text: str) -> np.ndarray:
    if text in _AXES:
        return np.array(_AXES[text], float)
    return np.array([float(x) for x in re.findall(_NUMBER, text)])


def _sine(axis: np.ndarray, direction: np.ndarray) -> float:
    return norm(np.cross(axis, direction))


def _angle(axis: np.ndarray, direction: np.ndarray) -> float:
    cosine = product(axis, direction) / norm(axis) / norm(direction)
    return math.acos(min(max(float(cosine), -1.0), 1.0))
