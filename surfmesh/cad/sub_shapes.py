"""Sub-shapes of a shape, by kind and by number, and how large shapes are: what OCP has to say."""

from __future__ import annotations

import math
from collections.abc import Iterable, Iterator
from typing import Generic, TypeVar

from OCP.Bnd import Bnd_Box
from OCP.BRep import BRep_Builder
from OCP.BRepBndLib import BRepBndLib
from OCP.BRepGProp import BRepGProp, BRepGProp_Domain, BRepGProp_Face, BRepGProp_Vinert
from OCP.gp import gp_Pnt
from OCP.GProp import GProp_GProps
from OCP.TopAbs import (
    TopAbs_EDGE,
    TopAbs_FACE,
    TopAbs_FORWARD,
    TopAbs_REVERSED,
    TopAbs_ShapeEnum,
)
from OCP.TopExp import TopExp, TopExp_Explorer
from OCP.TopoDS import (
    TopoDS,
    TopoDS_Compound,
    TopoDS_Edge,
    TopoDS_Face,
    TopoDS_Iterator,
    TopoDS_Shape,
)
from OCP.TopTools import TopTools_IndexedMapOfShape

Value = TypeVar("Value")


def each(
    shape: TopoDS_Shape, kind: TopAbs_ShapeEnum, avoid: TopAbs_ShapeEnum | None = None
) -> Iterator[TopoDS_Shape]:
    """Sub-shapes of a kind as they are used, none that is within another of the kind ``avoid``."""
    explorer = TopExp_Explorer()
    explorer.Init(shape, kind) if avoid is None else explorer.Init(shape, kind, avoid)
    while explorer.More():
        yield explorer.Current()
        explorer.Next()


def below(shape: TopoDS_Shape) -> Iterator[TopoDS_Shape]:
    """Direct sub-shapes, located and oriented as they are used."""
    iterator = TopoDS_Iterator(shape)
    while iterator.More():
        yield iterator.Value()
        iterator.Next()


class Numbering:
    """Shapes by number from 0 in the order in which they are met; ``IsSame`` shapes are one."""

    def __init__(
        self, shapes: Iterable[TopoDS_Shape] = (), kind: TopAbs_ShapeEnum | None = None
    ) -> None:
        self._map = TopTools_IndexedMapOfShape()
        for shape in shapes:
            self.add_within(shape, kind)

    def add(self, shape: TopoDS_Shape) -> int:
        """Number of a shape, the next one where it has not been met."""
        return self._map.Add(shape) - 1

    def add_within(self, shape: TopoDS_Shape, kind: TopAbs_ShapeEnum | None = None) -> None:
        """All sub-shapes of a kind; None: the shape and all below it."""
        if kind is None:
            TopExp.MapShapes_s(shape, self._map)
        else:
            TopExp.MapShapes_s(shape, kind, self._map)

    def find(self, shape: TopoDS_Shape) -> int | None:
        number = self._map.FindIndex(shape)
        return number - 1 if number else None

    def forget_after(self, count: int) -> None:
        """Only the first ``count`` shapes have been met."""
        while self._map.Extent() > count:
            self._map.RemoveLast()

    def __contains__(self, shape: TopoDS_Shape) -> bool:
        return self._map.Contains(shape)

    def __getitem__(self, number: int) -> TopoDS_Shape:
        return self._map.FindKey(number + 1)

    def __iter__(self) -> Iterator[TopoDS_Shape]:
        return (self[number] for number in range(len(self)))

    def __len__(self) -> int:
        return self._map.Extent()


class ByShape(Generic[Value]):
    """Values by shape, the same for shapes that are ``IsSame``."""

    def __init__(self) -> None:
        self._numbers = Numbering()
        self._values: list[Value] = []

    def setdefault(self, shape: TopoDS_Shape, value: Value) -> Value:
        """The value of a shape, which becomes ``value`` where it has none."""
        number = self._numbers.add(shape)
        if number == len(self._values):
            self._values.append(value)
        return self._values[number]

    def get(self, shape: TopoDS_Shape) -> Value | None:
        number = self._numbers.find(shape)
        return None if number is None else self._values[number]

    def items(self) -> Iterator[tuple[TopoDS_Shape, Value]]:
        return zip(self._numbers, self._values)


def unique(shape: TopoDS_Shape, kind: TopAbs_ShapeEnum) -> list[TopoDS_Shape]:
    """Sub-shapes of a kind, each once, in the order in which they are met."""
    return list(Numbering([shape], kind))


def faces_of(shape: TopoDS_Shape) -> list[TopoDS_Face]:
    """Each once, as it lies on its surface."""
    return [TopoDS.Face_s(face.Oriented(TopAbs_FORWARD)) for face in unique(shape, TopAbs_FACE)]


def edges_of(shape: TopoDS_Shape) -> list[TopoDS_Edge]:
    """Each once, oriented as it is used first."""
    return [TopoDS.Edge_s(edge) for edge in unique(shape, TopAbs_EDGE)]


def compound_of(shapes: Iterable[TopoDS_Shape]) -> TopoDS_Compound:
    """One compound of shapes, as they are."""
    compound, builder = TopoDS_Compound(), BRep_Builder()
    builder.MakeCompound(compound)
    for shape in shapes:
        builder.Add(compound, shape)
    return compound


def box_diagonal(shapes: Iterable[TopoDS_Shape], exact: bool = True) -> float:
    """Diagonal of the box around shapes, by their geometry; 0 where there is none.

    Else roughly, and at once: with room for their tolerances, and by triangles where they have any.
    """
    box = Bnd_Box()
    for shape in shapes:
        if exact:
            BRepBndLib.AddOptimal_s(shape, box, False, False)
        else:
            BRepBndLib.Add_s(shape, box)
    return 0.0 if box.IsVoid() else box.CornerMin().Distance(box.CornerMax())


def content(shape: TopoDS_Shape, dimension: int, error: float | None = None) -> float:
    """Volume (3), area (2) or length of all edges (1).

    A volume is negative where faces are turned inside out. error: relative, of adaptive
    integration, which splines make slow and sums of extrusions wrong; None: fixed Gauss points.
    """
    properties = GProp_GProps()
    if dimension == 1:
        BRepGProp.LinearProperties_s(shape, properties)
    else:
        integral = (BRepGProp.SurfaceProperties_s, BRepGProp.VolumeProperties_s)[dimension - 2]
        integral(shape, properties, *(() if error is None else (error,)))
    return properties.Mass()


def volume_within(
    faces: Iterable[TopoDS_Shape], errors: Iterable[float | None], middle: Iterable[float]
) -> float:
    """Volume of a solid with these faces, turned as it uses them, each with its own ``error``.

    They are those of ``content``, relative to the cone of the face over ``middle``. Where faces do
    not quite meet, the volume depends on that: ``content`` takes the mean of all vertices, each as
    often as an edge of a face uses it.
    """
    about, parts = gp_Pnt(*middle), []
    for face, error in zip(faces, errors):
        if face.Orientation() in (TopAbs_FORWARD, TopAbs_REVERSED):
            located = TopoDS.Face_s(face)
            surface, domain = BRepGProp_Face(located), BRepGProp_Domain(located)
            asked = () if error is None else (error,)
            parts.append(BRepGProp_Vinert(surface, domain, about, *asked).Mass())
    return math.fsum(parts)


def said_by(error: Exception) -> str:
    """What an exception of OCP says: they have no common parent in Python."""
    return f"{type(error).__name__} {error}".strip()


def counted(count: int, one: str, many: str = "") -> str:
    """ "1 face", "3 faces"."""
    return f"{count:,} {one if count == 1 else many or one + 's'}"
