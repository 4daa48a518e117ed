"""Parts and assemblies by name, as a reader hands them over.

A part's shape lies in the part's own frame and may stand in many places.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator
from dataclasses import dataclass, field, replace
from typing import NamedTuple

from OCP.BRep import BRep_Tool
from OCP.gp import gp_XYZ
from OCP.Quantity import Quantity_Color, Quantity_TypeOfColor
from OCP.TopAbs import TopAbs_VERTEX
from OCP.TopLoc import TopLoc_Location
from OCP.TopoDS import TopoDS, TopoDS_Face, TopoDS_Shape

from surfmesh.cad.model.cad_model import Colour
from surfmesh.cad.sub_shapes import ByShape, Numbering, each


class Detail(NamedTuple):
    """What is known of one solid, shell, face or edge of a part."""

    shape: TopoDS_Shape  # where it lies in the part
    name: str
    colour: Colour | None
    names: tuple[str, ...] = ()  # of all that it was made of, where those were several


class Details:
    """Details by shape; what is said first of a shape counts."""

    def __init__(self) -> None:
        self._of: ByShape[Detail] = ByShape()

    def add(self, details: Iterable[Detail]) -> None:
        for detail in details:
            self._of.setdefault(detail.shape, detail)

    def of(self, shape: TopoDS_Shape) -> Detail:
        """What is known of a shape: without a name and a colour where that is nothing."""
        return self._of.get(shape) or Detail(shape, "", None)


class Tag(NamedTuple):
    """A tag of CadQuery and the parts of the final shape that it stands for."""

    name: str
    held: str  # what was tagged, in words: "2 faces"
    shapes: list[TopoDS_Shape]  # where they lie in the part


@dataclass
class Part:
    """A node of the assembly tree.

    shape: of a part, in its own frame; None for an assembly. place: of that frame in the
    parent's, None where they are the same. colour: of everything below that has none of its
    own. details: names and colours within the shape. remarks: what healing did, and to which
    sub-shape (None: the part). tags: what they select. notes: whole sentences about the parts
    below, with what each is about (None: all of them). left_out: what of it cannot be meshed.
    """

    name: str
    shape: TopoDS_Shape | None = None
    place: TopLoc_Location | None = None
    colour: Colour | None = None
    details: list[Detail] = field(default_factory=list)
    children: list[Part] = field(default_factory=list)
    remarks: list[tuple[TopoDS_Shape | None, str]] = field(default_factory=list)
    tags: list[Tag] = field(default_factory=list)
    notes: list[tuple[TopoDS_Shape | None, str]] = field(default_factory=list)
    left_out: list[str] = field(default_factory=list)

    def __iter__(self) -> Iterator[Part]:
        """This part and all below it."""
        yield self
        for child in self.children:
            yield from child

    def noted(self, notes: Iterable[tuple[TopoDS_Shape | None, str]]) -> Part:
        """The part with more to say about what is below it."""
        return replace(self, notes=[*self.notes, *notes])

    def mapped(self, new_of: Callable[[TopoDS_Shape], TopoDS_Shape]) -> Part:
        """The part with every shape in it replaced; the places and the tree are as they were."""
        return replace(
            self,
            shape=new_of(self.shape),
            details=[d._replace(shape=new_of(d.shape)) for d in self.details],
            remarks=[(None if s is None else new_of(s), text) for s, text in self.remarks],
            tags=[tag._replace(shapes=[new_of(s) for s in tag.shapes]) for tag in self.tags],
        )


def face_in_words(face: TopoDS_Shape, part: Part, faces: Numbering) -> str:
    """Which of the ``faces`` of a part it is, its name, and where it lies."""
    number = faces.find(face)
    names = [detail.name for detail in part.details if detail.shape.IsSame(face)]
    called = f" ({names[0]})" if names and names[0] else ""
    which = "the only face" if len(faces) == 1 else f"face {(number or 0) + 1} of {len(faces)}"
    of = f" in {part.name!r}" if part.name else ""
    points = list(_points(TopoDS.Face_s(face)))
    where = ""
    if points:
        middle = gp_XYZ()
        for point in points:
            middle.Add(point)
        middle.Divide(len(points))
        where = f" near ({middle.X():.5g}, {middle.Y():.5g}, {middle.Z():.5g})"
    return f"{which}{of}{called}{where}"


def _points(face: TopoDS_Face) -> Iterator[gp_XYZ]:
    """Its vertices, or else those of its triangles."""
    vertices = list(each(face, TopAbs_VERTEX))
    if vertices:
        yield from (BRep_Tool.Pnt_s(TopoDS.Vertex_s(vertex)).XYZ() for vertex in vertices)
        return
    place = TopLoc_Location()
    mesh = BRep_Tool.Triangulation_s(face, place)
    if mesh is not None:
        for number in range(mesh.NbNodes()):
            yield mesh.Node(number + 1).Transformed(place.Transformation()).XYZ()


def screen_colour(colour: Quantity_Color) -> Colour:
    """(r, g, b) from 0 to 1 as screens and files mean it (sRGB); OCP's own are linear."""
    r, g, b = colour.Values(Quantity_TypeOfColor.Quantity_TOC_sRGB)
    return (float(r), float(g), float(b))
