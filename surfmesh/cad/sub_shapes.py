"""Sub-shapes of a shape, and shapes put together: what several modules need of OCP's topology."""

from __future__ import annotations

from collections.abc import Iterable, Iterator

from OCP.Bnd import Bnd_Box
from OCP.BRep import BRep_Builder
from OCP.BRepBndLib import BRepBndLib
from OCP.TopExp import TopExp, TopExp_Explorer
from OCP.TopoDS import TopoDS_Compound, TopoDS_Shape
from OCP.TopTools import TopTools_IndexedMapOfShape


def each(shape: TopoDS_Shape, kind, avoid=None) -> Iterator[TopoDS_Shape]:
    """Sub-shapes of a kind as they are used, none that is within another of the kind ``avoid``."""
    explorer = TopExp_Explorer()
    explorer.Init(shape, kind) if avoid is None else explorer.Init(shape, kind, avoid)
    while explorer.More():
        yield explorer.Current()
        explorer.Next()


def unique(shape: TopoDS_Shape, kind) -> list[TopoDS_Shape]:
    """Sub-shapes of a kind, each once, in the order in which they are met."""
    found = TopTools_IndexedMapOfShape()
    TopExp.MapShapes_s(shape, kind, found)
    return [found.FindKey(number + 1) for number in range(found.Extent())]


def compound_of(shapes: Iterable[TopoDS_Shape]) -> TopoDS_Compound:
    """One compound of shapes, as they are."""
    compound, builder = TopoDS_Compound(), BRep_Builder()
    builder.MakeCompound(compound)
    for shape in shapes:
        builder.Add(compound, shape)
    return compound


def box_diagonal(shapes: Iterable[TopoDS_Shape]) -> float:
    """Diagonal of the box around shapes, by their geometry; 0 where there is none."""
    box = Bnd_Box()
    for shape in shapes:
        BRepBndLib.AddOptimal_s(shape, box, False, False)
    return 0.0 if box.IsVoid() else box.CornerMin().Distance(box.CornerMax())


def counted(count: int, one: str, many: str = "") -> str:
    """ "1 face", "3 faces"."""
    return f"{count:,} {one if count == 1 else many or one + 's'}"
