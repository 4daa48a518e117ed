"""Faces, edges, vertices and solids of a model by name, number, colour, kind or selector.

fillet*            names of faces, edges, solids, parts and tags, with * ? [..]
face:12  edge:3-7  numbers; likewise vertex: and solid:
face:fillet*       names of faces alone; likewise edge: and solid:
face:>Z            a selector of CadQuery; without the word before it, of faces
color:#ff0000      colour of faces, also one by name (colour:red)
type:cylinder      kind of surface
name:>odd name     the rest is a name, whatever it looks like; likewise tag:
*                  everything
"""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator
from dataclasses import dataclass
from difflib import get_close_matches
from fnmatch import fnmatchcase

import numpy as np

from surfmesh.cad.model.cad_model import CadEdge, CadFace, CadModel, CadNode, CadSolid, Colour
from surfmesh.cad.selection.selectors import is_selector, selected
from surfmesh.errors import SizingError

EVERYTHING = "*"

SAME_COLOUR = 0.02
"""Of each channel, 0 to 1: colours in files are rounded."""

_PREFIXES = (
    "face", "edge", "vertex", "solid", "color", "colour", "type", "name", "tag"
)  # fmt: skip
_NUMBERS = re.compile(r"\d+(-\d+)?(,\d+(-\d+)?)*")
_KINDS = ("faces", "edges", "vertices", "solids")
_LISTED = 8
_LONGEST = 200  # of names that are compared with each other: it takes the square of the letters


@dataclass(frozen=True)
class Selection:
    """What a key finds, by number, each sorted."""

    faces: tuple[int, ...] = ()
    edges: tuple[int, ...] = ()
    vertices: tuple[int, ...] = ()
    solids: tuple[int, ...] = ()

    def __bool__(self) -> bool:
        return bool(self.faces or self.edges or self.vertices or self.solids)

    def __str__(self) -> str:
        parts = [
            f"{len(found)} {one if len(found) == 1 else many}"
            for found, one, many in (
                (self.faces, "face", "faces"), (self.edges, "edge", "edges"),
                (self.vertices, "vertex", "vertices"), (self.solids, "solid", "solids"),
            ) if found
        ]  # fmt: skip
        return ", ".join(parts) or "nothing"


def select(model: CadModel, key: str) -> Selection:
    """What ``key`` finds. Raises ``SizingError`` when that is nothing, with names that are near."""
    prefix, sign, rest = key.partition(":")
    prefix, rest = prefix.strip().lower(), rest.strip()
    if key.strip() == EVERYTHING:
        return Selection(
            tuple(range(len(model.faces))), tuple(range(len(model.edges))),
            tuple(range(len(model.vertices))), tuple(range(len(model.solids))),
        )  # fmt: skip
    if sign and prefix in ("color", "colour"):
        found = _of_colour(model, rest)
    elif sign and prefix == "type":
        found = Selection(
            tuple(k for k, face in enumerate(model.faces) if fnmatchcase(face.kind, rest.lower()))
        )
    elif sign and prefix in ("face", "edge", "vertex", "solid"):
        found = _of_one_kind(model, prefix, rest, key)
    elif sign and prefix in ("name", "tag"):
        found = _named(model, rest)
    elif is_selector(key):
        found = Selection(tuple(selected(model, "face", key)))
    else:
        found = _named(model, key)
    if not found:
        lost = [tag for tag in model.tags if _is_called(tag.name, rest if sign else key)]
        lost = [tag for tag in lost if not any(getattr(tag, kind) for kind in _KINDS)]
        if lost:
            raise SizingError(
                f"tag {lost[0].name!r} stands for nothing in the final shape: later steps have "
                f"removed or replaced what it held ({lost[0].held}); tag what is there at the end"
            )
        raise SizingError(f"{key!r:.200} selects nothing of {model.name or model.source!r}; "
                          + _advice(model, key, prefix if sign else ""))  # fmt: skip
    return found


def names(model: CadModel) -> dict[str, str]:
    """All names in a model, and what has them."""
    found: dict[str, str] = {}
    for kind, items in (("face", model.faces), ("edge", model.edges), ("solid", model.solids)):
        for item in items:
            for name in (item.name, *item.names):
                if name:
                    found.setdefault(name, kind)
    for node in _nodes(model.tree):
        if node.name:
            found.setdefault(node.name, "part")
    for tag in model.tags:
        found.setdefault(tag.name, "tag")
    return found


def _nodes(node: CadNode) -> Iterator[CadNode]:
    yield node
    for child in node.children:
        yield from _nodes(child)


def _named(model: CadModel, pattern: str) -> Selection:
    """By the names of faces, edges, solids, of tags, and of parts with all below them."""
    faces, edges, solids = (
        _matching(items, pattern) for items in (model.faces, model.edges, model.solids)
    )
    vertices: set[int] = set()
    for tag in model.tags:
        if _is_called(tag.name, pattern):
            for kind, into in zip(_KINDS, (faces, edges, vertices, solids)):
                into.update(getattr(tag, kind))
    for node in _nodes(model.tree):
        if _is_called(node.name, pattern):
            for part in _nodes(node):
                solids.update(part.solids)
                faces.update(part.faces)
    return Selection(*(tuple(sorted(some)) for some in (faces, edges, vertices, solids)))


def _matching(items: Iterable[CadFace | CadEdge | CadSolid], pattern: str) -> set[int]:
    """Numbers of those that have such a name; what imprinting made of several has all theirs."""
    return {
        k for k, item in enumerate(items)
        if any(_is_called(name, pattern) for name in (item.name, *item.names))
    }  # fmt: skip


def _is_called(name: str, pattern: str) -> bool:
    return bool(name) and fnmatchcase(name, pattern)


def _of_one_kind(model: CadModel, kind: str, rest: str, key: str) -> Selection:
    many = "vertices" if kind == "vertex" else f"{kind}s"
    count = len(getattr(model, many))
    if rest == EVERYTHING:
        return Selection(**{many: tuple(range(count))})
    if _NUMBERS.fullmatch(rest.replace(" ", "")):
        wanted: set[int] = set()
        for span in rest.replace(" ", "").split(","):
            first, last = (_number(end) for end in (span.split("-") * 2)[:2])
            if last >= count or first > last:
                raise SizingError(
                    f"{key!r:.80}: there is no {kind} {span:.30}; "
                    f"{model.name or model.source!r} has {count}, numbered from 0"
                )
            wanted.update(range(first, last + 1))
        return Selection(**{many: tuple(sorted(wanted))})
    if is_selector(rest):
        return Selection(**{many: tuple(selected(model, kind, rest))})
    if kind in ("vertex", "solid"):
        return Selection(**{many: getattr(_named(model, rest), many)})
    found = _matching(model.faces if kind == "face" else model.edges, rest)
    for tag in model.tags:
        if _is_called(tag.name, rest):
            found.update(getattr(tag, many))
    return Selection(**{many: tuple(sorted(found))})


def _number(digits: str) -> int:
    """Of so many digits that Python refuses them: larger than any face has."""
    return int(digits) if len(digits) <= 18 else 10**18


def _of_colour(model: CadModel, text: str) -> Selection:
    wanted = np.array(_colour(text))
    near = [
        k for k, face in enumerate(model.faces)
        if face.colour is not None and np.abs(np.array(face.colour) - wanted).max() <= SAME_COLOUR
    ]  # fmt: skip
    return Selection(tuple(near))


def _colour(text: str) -> Colour:
    """Of "#ff0000" or a name that is known in HTML."""
    from matplotlib.colors import to_rgb

    try:
        return to_rgb(text)
    except ValueError:
        raise SizingError(
            f"{text!r} is no colour: write it as '#ff0000' or by a name as in HTML"
        ) from None


def _advice(model: CadModel, key: str, prefix: str) -> str:
    """What there is instead."""
    if prefix in ("color", "colour"):
        colours = sorted({_hexadecimal(face.colour) for face in model.faces if face.colour})
        return f"its colours are {_some(colours)}" if colours else "none of its faces has a colour"
    if prefix == "type":
        return f"its kinds of faces are {_some(sorted({face.kind for face in model.faces}))}"
    known = names(model)
    sought = key.partition(":")[2] if prefix in _PREFIXES else key
    alike = [name for name in known if len(name) <= _LONGEST] if len(sought) <= _LONGEST else []
    near = get_close_matches(sought, alike, 3, 0.5)
    if near:
        return "did you mean " + " or ".join(repr(name) for name in near) + "?"
    if not known:
        return "nothing in it has a name: select by number (face:12), kind (type:cylinder) or '>Z'"
    return f"its names are {_some(sorted(known))}"


def _some(words: list[str]) -> str:
    more = len(words) - _LISTED
    return ", ".join(map(repr, words[:_LISTED])) + (f" and {more} more" if more > 0 else "")


def _hexadecimal(colour: Colour) -> str:
    return "#" + "".join(f"{round(255 * channel):02x}" for channel in colour)
