"""Closed shells become solids; one that looks inward within another is a void of that.

 ________            ________
|  ____  |          |  ____  |
| |    | |    ->    | |void| |    one solid: the outer shell and the inner one
| |____| |          | |____| |
|________|          |________|
"""

from __future__ import annotations

from dataclasses import dataclass

from OCP.BRep import BRep_Builder, BRep_Tool
from OCP.BRepClass3d import BRepClass3d_SolidClassifier
from OCP.TopAbs import TopAbs_IN, TopAbs_SHELL, TopAbs_VERTEX
from OCP.TopoDS import TopoDS, TopoDS_Shape, TopoDS_Solid

from surfmesh.cad.sub_shapes import content, each

PartPath = tuple[int, ...]
"""Of a part: which child of which child of the root."""


@dataclass
class SewnShell:
    """The faces of one piece."""

    shape: TopoDS_Shape
    path: PartPath
    """Of the part that it belongs to."""
    inherited: list
    """Colours that faces have from parts below that."""
    inward: bool
    """Do its faces, as they came, look at what it encloses?"""


@dataclass
class Body:
    """What has become of a shell: a solid where it is closed, or it alone."""

    shape: TopoDS_Shape
    path: PartPath


def bodies_of(shells: list[SewnShell]) -> list[Body]:
    """Solids of closed shells; one that looks inward within another is a void of that."""
    found, closed = [], []
    for shell in shells:
        if shell.shape.ShapeType() == TopAbs_SHELL and BRep_Tool.IsClosed_s(shell.shape):
            closed.append(shell)
        else:
            found.append(Body(shell.shape, shell.path))
    solids = [_solid_of(shell.shape) for shell in closed]
    voids: dict[int, list[int]] = {}
    for number, shell in enumerate(closed):
        if shell.inward and len(closed) > 1:
            around = [k for k in range(len(closed)) if k != number and _is_within(shell, solids[k])]
            outer = [k for k in around if not closed[k].inward]
            if outer:
                smallest = min(outer, key=lambda k: abs(content(solids[k], 3)))
                voids.setdefault(smallest, []).append(number)
    taken = {number for inner in voids.values() for number in inner}
    for number, shell in enumerate(closed):
        if number not in taken:
            inner = [solids[k] for k in voids.get(number, ())]
            found.append(Body(_with_voids(solids[number], inner), shell.path))
    return found


def _solid_of(shell: TopoDS_Shape) -> TopoDS_Solid:
    """A solid with its faces outward."""
    if content(shell, 3) < 0.0:
        shell = shell.Reversed()
    builder, solid = BRep_Builder(), TopoDS_Solid()
    builder.MakeSolid(solid)
    builder.Add(solid, shell)
    return solid


def _is_within(shell: SewnShell, solid: TopoDS_Solid) -> bool:
    vertex = next(each(shell.shape, TopAbs_VERTEX), None)
    if vertex is None:
        return False
    point = BRep_Tool.Pnt_s(TopoDS.Vertex_s(vertex))
    return BRepClass3d_SolidClassifier(solid, point, 1e-7).State() == TopAbs_IN


def _with_voids(solid: TopoDS_Solid, inner: list[TopoDS_Solid]) -> TopoDS_Solid:
    for void in inner:
        for shell in each(void, TopAbs_SHELL):
            BRep_Builder().Add(solid, shell.Reversed())
    return solid
