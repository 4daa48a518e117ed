"""What a mesh knows of its faces, solids and edges besides numbers: plain data, no CAD.

Numbers are those of ``SurfaceMesh.face_ids``, ``solid_ids`` and ``edge_ids``. A tuple may be
shorter than the numbers go: what it does not hold has no name and no colour.
"""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, fields, replace
from math import isfinite
from typing import Any, Self

from surfmesh.geometry.surface import Surface, surface_kind

Colour = tuple[float, float, float]  # red, green, blue from 0 to 1, sRGB

METRES = {"um": 1e-6, "mm": 1e-3, "cm": 1e-2, "m": 1.0, "in": 0.0254, "ft": 0.3048}
"""Metres in a unit of length."""


@dataclass(frozen=True, kw_only=True)
class MeshGroups:
    """Names, colours and kinds by number; '' and None where there is none.

    What cannot be printed in a name (ends of lines, control characters, halves of pairs) becomes
    a blank: files of text would break there.
    """

    face_names: tuple[str, ...] = ()
    face_colours: tuple[Colour | None, ...] = ()
    face_kinds: tuple[str, ...] = ()  # of surface: plane, cylinder, ...
    solid_names: tuple[str, ...] = ()
    solid_colours: tuple[Colour | None, ...] = ()
    edge_names: tuple[str, ...] = ()
    unit: str = ""  # of length: mm, m, in, ...; '' when it is not known

    def __post_init__(self) -> None:
        for name in ("face_names", "face_kinds", "solid_names", "edge_names"):
            object.__setattr__(self, name, _all_printable(tuple(getattr(self, name))))
        for name in ("face_colours", "solid_colours"):
            found = (c and tuple(map(float, c)) for c in getattr(self, name))
            object.__setattr__(self, name, tuple(found))

    @classmethod
    def of_surfaces(cls, surfaces: Sequence[Surface]) -> Self:
        """What surfaces say of themselves."""
        return cls(
            face_names=tuple(surface.name for surface in surfaces),
            face_kinds=tuple(surface_kind(surface) for surface in surfaces),
        )

    @classmethod
    def of_plain(cls, plain: Mapping[str, Any]) -> Self:
        """From what ``plain`` gives; what it does not hold is empty, the rest is passed over.

        Raises ``ValueError`` for names and colours that are no lists, a colour that is not three
        numbers and a unit that is no text.
        """
        known = {item.name for item in fields(cls)}
        try:
            found = cls(**{name: value for name, value in plain.items() if name in known})
        except TypeError:
            raise ValueError("names or colours of groups are no lists") from None
        colours = filter(None, (*found.face_colours, *found.solid_colours))
        if any(len(c) != 3 or not all(map(isfinite, c)) for c in colours):
            raise ValueError("a colour is not three numbers")
        if not isinstance(found.unit, str):
            raise ValueError(f"the unit {found.unit!r} is no text")
        return replace(found, unit=_printable(found.unit))

    def plain(self) -> dict[str, Any]:
        """Lists, numbers and strings, for JSON; only what there is."""
        held = {item.name: getattr(self, item.name) for item in fields(self)}
        return {name: value for name, value in held.items() if value}

    def face_label(self, face: int) -> str:
        """The name of a face, or ``face 3``. Faces of one name are one group in files."""
        return _entry(self.face_names, face) or f"face {face}"

    def solid_label(self, solid: int) -> str:
        """The name of a solid, or ``solid 3``."""
        return _entry(self.solid_names, solid) or f"solid {solid}"

    def edge_label(self, edge: int) -> str:
        """The name of an edge, or ``edge 3``."""
        return _entry(self.edge_names, edge) or f"edge {edge}"

    def face_kind(self, face: int) -> str:
        """The kind of surface under a face, or ''."""
        return _entry(self.face_kinds, face) or ""

    def face_colour(self, face: int) -> Colour | None:
        """The colour of a face."""
        return _entry(self.face_colours, face)

    def solid_colour(self, solid: int) -> Colour | None:
        """The colour of a solid."""
        return _entry(self.solid_colours, solid)


def _all_printable(texts: tuple) -> tuple[str, ...]:
    if set(map(type, texts)) <= {str} and "".join(texts).isprintable():
        return texts
    return tuple(map(_printable, texts))


def _printable(text: str | None) -> str:
    said = str(text or "")
    if said.isprintable():
        return said
    return "".join(mark if mark.isprintable() else " " for mark in said)


def _entry(values: tuple, number: int) -> Any:
    return values[number] if 0 <= number < len(values) else None
