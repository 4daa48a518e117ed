"""The check of a shape in parts says what OCP's checker says of the whole."""

import pytest
from OCP.BRepBuilderAPI import (
    BRepBuilderAPI_MakeEdge,
    BRepBuilderAPI_MakeFace,
    BRepBuilderAPI_MakePolygon,
    BRepBuilderAPI_MakeWire,
)
from OCP.BRepCheck import BRepCheck_Analyzer
from OCP.BRepPrimAPI import BRepPrimAPI_MakePrism
from OCP.gp import gp_Ax2, gp_Circ, gp_Dir, gp_Pln, gp_Pnt, gp_Vec
from OCP.TopoDS import TopoDS, TopoDS_Face, TopoDS_Shell, TopoDS_Solid, TopoDS_Wire

from surfmesh.cad.healing import validity

HOLES = 12  # each way

FAULTS = {
    "crossing_holes": (0.25, 0.0, 0.2, True),
    "hole_in_hole": (0.0, 0.0, 0.1, True),
    "island_in_hole": (0.0, 0.0, 0.1, False),
    "hole_across_the_rim": (-1.0, 5.5, 0.2, True),
    "hole_beside_the_plate": (-5.0, 5.5, 0.2, True),
    "hole_the_wrong_way_round": (0.5, 0.5, 0.05, False),
}


def circle(x: float, y: float, radius: float, is_hole: bool) -> TopoDS_Wire:
    curve = gp_Circ(gp_Ax2(gp_Pnt(x, y, 0), gp_Dir(0, 0, 1)), radius)
    wire = BRepBuilderAPI_MakeWire(BRepBuilderAPI_MakeEdge(curve).Edge()).Wire()
    return TopoDS.Wire_s(wire.Reversed()) if is_hole else wire


def plate(*more: tuple[float, float, float, bool]) -> TopoDS_Face:
    """A square with a lattice of holes, each row a little to the side."""
    rim = BRepBuilderAPI_MakePolygon()
    for x, y in ((-1, -1), (HOLES, -1), (HOLES, HOLES), (-1, HOLES)):
        rim.Add(gp_Pnt(x, y, 0))
    rim.Close()
    maker = BRepBuilderAPI_MakeFace(gp_Pln(gp_Pnt(0, 0, 0), gp_Dir(0, 0, 1)), rim.Wire())
    for i in range(HOLES):
        for j in range(HOLES):
            maker.Add(circle(i + 0.03 * j, j, 0.2, True))
    for hole in more:
        maker.Add(circle(*hole))
    return maker.Face()


def test_many_holes_are_checked_in_groups():
    face = plate()
    parts = validity._holes_in_groups(face)
    assert len(parts) == HOLES**2 // validity.AT_ONCE
    assert validity._is_valid_in_parts(face, {hash(face): parts})
    assert validity._is_valid_in_parts(TopoDS.Face_s(face.Reversed()), {hash(face): parts})
    assert BRepCheck_Analyzer(face).IsValid()


def test_a_solid_between_such_planes():
    solid = BRepPrimAPI_MakePrism(plate(), gp_Vec(0, 0, 1)).Shape()
    parts = {
        hash(face): holes
        for face in validity.unique(solid, validity.TopAbs_FACE)
        if (holes := validity._holes_in_groups(TopoDS.Face_s(face)))
    }
    assert len(parts) == 2
    assert validity._is_valid_in_parts(solid, parts)


@pytest.mark.parametrize("fault", FAULTS)
def test_what_is_wrong_is_found(fault: str):
    face = plate(FAULTS[fault])
    assert not BRepCheck_Analyzer(face).IsValid()
    assert not validity.is_valid(face)
    parts = validity._holes_in_groups(face)
    assert not parts or not validity._is_valid_in_parts(face, {hash(face): parts})


@pytest.mark.parametrize("turned_over", [False, True])
def test_the_shells_of_solids_are_looked_at(turned_over: bool):
    """One of them lacks a face, or has one that is turned over."""
    whole = BRepPrimAPI_MakePrism(plate(), gp_Vec(0, 0, 1)).Shape()
    first, *others = validity.unique(whole, validity.TopAbs_FACE)
    shell, solid, builder = TopoDS_Shell(), TopoDS_Solid(), validity.BRep_Builder()
    builder.MakeShell(shell)
    for face in [first.Reversed()] * turned_over + others:
        builder.Add(shell, face)
    shell.Closed(True)
    builder.MakeSolid(solid)
    builder.Add(solid, shell)
    assert not BRepCheck_Analyzer(solid).IsValid()
    assert not validity._is_valid_in_parts(solid, {})
    assert not validity.is_valid(solid)
