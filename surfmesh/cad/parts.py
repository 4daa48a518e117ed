"""What a reader hands over: parts and assemblies by name, with their shapes in place."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, NamedTuple

if TYPE_CHECKING:
    from OCP.TopoDS import TopoDS_Shape

    from surfmesh.cad.model import Colour


class Detail(NamedTuple):
    """What is known of one solid, shell, face or edge of a part."""

    shape: TopoDS_Shape  # where it lies in the part
    name: str
    colour: Colour | None


@dataclass
class Part:
    """A node of the assembly tree.

    shape: in its own place in the whole, or None for an assembly. colour: of everything below
    that has none of its own. details: names and colours within the shape.
    """

    name: str
    shape: TopoDS_Shape | None = None
    colour: Colour | None = None
    details: list[Detail] = field(default_factory=list)
    children: list[Part] = field(default_factory=list)

    def __iter__(self) -> Iterator[Part]:
        """This part and all below it."""
        yield self
        for child in self.children:
            yield from child
