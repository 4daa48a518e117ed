"""Sizes by name: selections of a CAD model, resolved to the sizes of each face, edge and vertex.

    {"*": base, "fillet*": Sizing(chord=0.01), ">Z": 0.5, "vertex:3": 0.1}
        -> base with defaults; faces {4: ..., 5: ...}; edges {...}; vertices {3: 0.1}

All that apply hold: the smallest of the chords, angles and sizes, of all sources; between the
largest of the min_size and the smallest of the max_size. ``growth`` and ``anisotropy`` are of
the whole model.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field, fields
from difflib import get_close_matches
from fnmatch import fnmatchcase
from typing import Any, NamedTuple

import numpy as np

from surfmesh.cad.model.cad_model import CadModel
from surfmesh.cad.selection.selection import EVERYTHING, Selection, select
from surfmesh.errors import SizingError, shown
from surfmesh.sizing.options.defaults import with_defaults
from surfmesh.sizing.options.other_words import own_word
from surfmesh.sizing.options.sizing import Sizing

OF_THE_MODEL = (
    "growth", "anisotropy", "limit", "gap_faces", "volume", "triangles", "proof", "fewest",
    "order", "vertices",
)  # fmt: skip
"""Options that cannot differ from selection to selection."""


class Entry(NamedTuple):
    """One entry: the key, its sizes, what it selects."""

    key: str
    sizing: Sizing
    found: Selection
    derived: bool = False
    """It follows from an option of the whole model, and sets no default aside."""


@dataclass(frozen=True)
class ModelSizing:
    """Sizes of a whole model; what is not listed has those of ``base``."""

    base: Sizing
    """With the model's defaults filled in."""
    faces: Mapping[int, Sizing] = field(default_factory=dict)
    edges: Mapping[int, Sizing] = field(default_factory=dict)
    vertices: Mapping[int, Sizing] = field(default_factory=dict)
    entries: tuple[Entry, ...] = ()
    """As they were given, but for "*", and those that ``volume`` makes."""
    stated: Sizing = field(default_factory=Sizing)
    """``base`` without the defaults."""
    promised: ModelSizing | None = None
    """What the mesh is held to, where chords that follow from ``volume`` are none of it."""

    @property
    def is_anisotropic(self) -> bool:
        """Do sizes depend on the direction anywhere?"""
        return any(own.is_anisotropic for own in (self.base, *self.faces.values()))

    def of_face(self, number: int) -> Sizing:
        """All that is asked for on a face."""
        return self.faces.get(number, self.base)

    def sets(self, count: int) -> list[tuple[Sizing, np.ndarray]]:
        """Each set of sizes that some of ``count`` faces have, and the numbers of these, rising."""
        if not self.faces:
            return [(self.base, np.arange(count))] if count else []
        others: dict[int, tuple[Sizing, list[int]]] = {}
        of_base = np.ones(count, bool)
        for number, own in sorted(self.faces.items(), key=lambda item: item[0]):
            if own is not self.base:
                others.setdefault(id(own), (own, []))[1].append(number)
                of_base[number] = False
        found = [(self.base, np.flatnonzero(of_base))] if of_base.any() else []
        return found + [(own, np.array(numbers, np.int64)) for own, numbers in others.values()]

    def promises(self, count: int) -> np.ndarray | None:
        """(count, 3) chord, angle and min_size of the faces, nan for none; None: those of base."""
        if self.promised is not None:
            return self.promised.promises(count)
        if not self.faces:
            return None
        names = ("chord", "angle", "min_size")
        every = [[getattr(self.of_face(k), name) for name in names] for k in range(count)]
        return np.array(every, float)

    def entries_of(self, kind: str, number: int) -> list[Entry]:
        """The entries that select a face, also by its solid, an edge or a vertex."""
        return [entry for entry in self.entries if number in getattr(entry.found, kind)]


def model_sizing(model: CadModel, given: Any) -> ModelSizing:
    """From what a user may pass: a Sizing, a number, options, or a mapping of selections.

    Raises ``SizingError`` for a key that selects nothing, an unknown option, and sizes that
    contradict each other.
    """
    if isinstance(given, ModelSizing):
        return given
    if not is_by_selection(given):
        stated = Sizing.of(given)
        return ModelSizing(with_defaults(stated, model.diagonal), stated=stated)
    base = Sizing.of(given.get(EVERYTHING))
    entries = []
    for key, value in given.items():
        if key == EVERYTHING:
            continue
        if not isinstance(key, str):
            raise SizingError(f"sizes are selected by text, not by {shown(key)}")
        own = _own_sizes(key, value)
        entries.append(Entry(key, own, _with_faces(model, _selected(model, key, value))))
    return ModelSizing(
        with_defaults(base, model.diagonal),
        faces=_combined(model, base, entries, "faces"),
        edges=_combined(model, base, entries, "edges"),
        vertices=_combined(model, base, entries, "vertices"),
        entries=tuple(entries),
        stated=base,
    )


def sizes_of_one_face(name: str, given: Mapping[Any, Any]) -> Sizing:
    """Sizes by selection for a surface without a CAD model: one face, which "*", its name (or a
    pattern of it) and "face:0" select. All that apply hold, as on the faces of a model.

    Raises ``SizingError`` for a key that selects nothing and sizes that contradict each other.
    """
    found = [(EVERYTHING, Sizing.of(given.get(EVERYTHING)))]
    for key, value in given.items():
        if key == EVERYTHING:
            continue
        if not isinstance(key, str) or not (key == "face:0" or fnmatchcase(name, key)):
            if own_word(str(key)) or get_close_matches(str(key), _OPTIONS, 1):
                Sizing.of({key: value})  # an option, not a selection: it says which is meant
            called = f"{name!r}, '*'" if name else "'*'"
            raise SizingError(
                f"sizes of {shown(key)}: a surface is one face, which {called} or 'face:0' "
                "selects; kinds, places and edges are selected on CAD models"
            )
        found.append((key, _own_sizes(key, value)))
    return combined(found)


def is_by_selection(given: Any) -> bool:
    """Is it a mapping of selections, and not of options? Raises ``SizingError`` for a mixture."""
    if not isinstance(given, Mapping) or not given:
        return False
    options = [key for key in given if key in _OPTIONS]
    if options and len(options) < len(given):
        other = next(key for key in given if key not in _OPTIONS)
        near = get_close_matches(str(other), _OPTIONS, 1)
        hint = f"did you mean {near[0]!r}? " if near else ""
        raise SizingError(
            f"unknown size option {other!r} beside {options[0]!r}: {hint}options of the whole "
            "model beside selections are written under '*'"
        )
    return not options


_OPTIONS = {option.name for option in fields(Sizing)}


def _selected(model: CadModel, key: str, value: Any) -> Selection:
    try:
        return select(model, key)
    except SizingError as error:
        near = get_close_matches(key, _OPTIONS, 1)
        if near and not isinstance(value, (Sizing, Mapping)):
            raise SizingError(f"{error}; or did you mean the option {near[0]!r}?") from None
        raise


def _own_sizes(key: str, value: Any) -> Sizing:
    try:
        sizing = Sizing.of(value)
    except SizingError as error:
        raise SizingError(f"sizes of {shown(key)}: {error}") from None
    default = Sizing()
    for name in OF_THE_MODEL:
        given = isinstance(value, Mapping) and name in value
        if given or getattr(sizing, name) != getattr(default, name):
            raise SizingError(
                f"sizes of {shown(key)}: {name} holds for the whole model; write it under '*'"
            )
    if sizing == default:
        raise SizingError(f"sizes of {shown(key)}: nothing is asked for")
    return sizing


def _with_faces(model: CadModel, found: Selection) -> Selection:
    """Solids bring their faces."""
    faces = set(found.faces)
    for number in found.solids:
        faces.update(face for shell in model.solids[number].shells for face, _ in shell)
    return Selection(tuple(sorted(faces)), found.edges, found.vertices, found.solids)


def _combined(model: CadModel, base: Sizing, entries: list[Entry], kind: str) -> dict[int, Sizing]:
    """The sizes of everything of a kind that some entry selects; equal ones are one object."""
    by_entries: dict[tuple[int, ...], Sizing] = {}
    entries_of: dict[int, list[int]] = {}
    for place, entry in enumerate(entries):
        for number in getattr(entry.found, kind):
            entries_of.setdefault(number, []).append(place)
    result = {}
    for number, places in entries_of.items():
        key = tuple(places)
        if key not in by_entries:
            given = [(EVERYTHING, base), *((entries[k].key, entries[k].sizing) for k in places)]
            by_entries[key] = with_defaults(combined(given), model.diagonal)
        result[number] = by_entries[key]
    return result


def combined(given: list[tuple[str, Sizing]]) -> Sizing:
    """All sizes at once; the first is that of the whole model.

    Raises ``SizingError`` when the largest ``min_size`` is above the smallest ``max_size``.
    """
    base = given[0][1]
    changes: dict[str, Any] = {}
    for name in ("chord", "angle", "max_size"):
        values = [(getattr(s, name), key) for key, s in given if getattr(s, name) is not None]
        changes[name] = min(values)[0] if values else None
    numbers = [s.size for _, s in given if isinstance(s.size, float)]
    laws = tuple(s.size for _, s in given if callable(s.size))
    changes["size"] = min(numbers) if numbers else None
    if laws:  # a number beside a law bounds it
        changes["size"] = laws[0] if len(laws) == 1 else LeastOf(laws)
        bounds = [*numbers, *([changes["max_size"]] if changes["max_size"] else [])]
        changes["max_size"] = min(bounds) if bounds else None
    lows = [(s.min_size, key) for key, s in given if s.min_size is not None]
    changes["min_size"] = max(lows)[0] if lows else None
    highs = [(s.max_size, key) for key, s in given if s.max_size is not None]
    highs += [(s.size, key) for key, s in given if isinstance(s.size, float)]
    if lows and highs and max(lows)[0] > min(highs)[0]:
        (low, of_low), (high, of_high) = max(lows), min(highs)
        raise SizingError(
            f"min_size {low:g} of {of_low!r} is above the largest size {high:g} that {of_high!r} "
            "allows on the same part of the model"
        )
    changes["sources"] = tuple(dict.fromkeys(source for _, s in given for source in s.sources))
    gaps = [s.gap for _, s in given if s.gap is not None]
    changes["gap"] = max(gaps) if gaps else None
    return base.replaced(**changes)


@dataclass(frozen=True)
class LeastOf:
    """A size law: the smallest of several."""

    laws: tuple[Callable[[np.ndarray], np.ndarray], ...]

    def __call__(self, points: np.ndarray) -> np.ndarray:
        return np.min([np.asarray(law(points), float) for law in self.laws], axis=0)
