"""Small shapes with known numbers, and files made from them."""

import cadquery as cq
from OCP.BRep import BRep_Builder
from OCP.BRepBuilderAPI import BRepBuilderAPI_MakeFace, BRepBuilderAPI_MakeWire
from OCP.BRepTools import BRepTools
from OCP.Geom import Geom_CylindricalSurface, Geom_SphericalSurface
from OCP.gp import gp_Ax2, gp_Ax3, gp_Circ, gp_Dir, gp_Pnt
from OCP.TopAbs import TopAbs_INTERNAL
from OCP.TopoDS import TopoDS_Compound, TopoDS_Edge, TopoDS_Face


def box_with_hole() -> cq.Workplane:
    """10 x 20 x 30 with a hole of diameter 4 along z."""
    return cq.Workplane().box(10, 20, 30).faces(">Z").workplane().hole(4)


def cut_boxes() -> cq.Compound:
    """Two boxes 1 x 1 x 1 and 2 x 1 x 1 that share a face, by a general fuse of touching ones."""
    from OCP.BOPAlgo import BOPAlgo_Builder

    fuse = BOPAlgo_Builder()
    fuse.AddArgument(cq.Solid.makeBox(1, 1, 1).wrapped)
    fuse.AddArgument(cq.Solid.makeBox(2, 1, 1, cq.Vector(1, 0, 0)).wrapped)
    fuse.Perform()
    return cq.Shape.cast(fuse.Shape())


def cylinder_without_seam(radius: float = 2.0, height: float = 3.0) -> TopoDS_Face:
    """A band around a cylinder whose two loops are the circles alone, as some files have it."""
    surface = Geom_CylindricalSurface(gp_Ax3(), radius)
    builder, face = BRep_Builder(), TopoDS_Face()
    builder.MakeFace(face, surface, 1e-7)
    for z, turned in ((0.0, False), (height, True)):
        wire = cq.Wire.makeCircle(radius, cq.Vector(0, 0, z), cq.Vector(0, 0, 1)).wrapped
        builder.Add(face, wire.Reversed() if turned else wire)
    return face


def bare_sphere(radius: float = 2.0) -> TopoDS_Face:
    """A sphere without a single edge."""
    face = TopoDS_Face()
    BRep_Builder().MakeFace(face, Geom_SphericalSurface(gp_Ax3(), radius), 1e-7)
    return face


def circle_without_vertex(radius: float = 2.0) -> TopoDS_Face:
    """A disc whose edge has no vertex."""
    from OCP.Geom import Geom_Circle

    builder, edge = BRep_Builder(), TopoDS_Edge()
    axes = gp_Ax2(gp_Pnt(0, 0, 0), gp_Dir(0, 0, 1))
    builder.MakeEdge(edge, Geom_Circle(gp_Circ(axes, radius)), 1e-7)
    builder.Range(edge, 0.0, 6.283185307179586)
    edge.Closed(True)
    return BRepBuilderAPI_MakeFace(BRepBuilderAPI_MakeWire(edge).Wire(), True).Face()


def square_with_inner_edges() -> TopoDS_Face:
    """A unit square with two connected edges inside it that belong to no loop."""
    face = cq.Face.makePlane(1, 1).wrapped
    builder = BRep_Builder()
    middle = cq.Edge.makeLine(cq.Vector(-0.2, 0, 0), cq.Vector(0.2, 0, 0))
    up = cq.Edge.makeLine(middle.endPoint(), cq.Vector(0.2, 0.3, 0))
    corner = cq.Wire.assembleEdges([middle, up])
    wire = cq.Wire(corner.wrapped.Oriented(TopAbs_INTERNAL)).wrapped
    builder.Add(face, wire)
    return face


def patch_without_pcurves() -> TopoDS_Face:
    """A patch of a cylinder whose edges have curves in space only."""
    solid = cq.Workplane().cylinder(3, 2).cut(cq.Workplane().box(2, 9, 9).translate((2.5, 0, 0)))
    face = next(f for f in solid.faces().vals() if f.geomType() == "CYLINDER")
    surface = Geom_CylindricalSurface(gp_Ax3(gp_Pnt(0, 0, -1.5), gp_Dir(0, 0, 1)), 2.0)
    builder, bare = BRep_Builder(), TopoDS_Face()
    builder.MakeFace(bare, surface, 1e-7)
    edges = [edge.copy() for edge in face.outerWire().Edges()]  # p-curves of another surface
    builder.Add(bare, cq.Wire.assembleEdges(edges).wrapped)
    return bare


def reversed_loop() -> TopoDS_Face:
    """A square whose hole runs the same way round as its outer loop."""
    face = cq.Face.makePlane(4, 4).wrapped
    hole = cq.Wire.makeCircle(1.0, cq.Vector(0, 0, 0), cq.Vector(0, 0, 1))
    BRep_Builder().Add(face, hole.wrapped)
    return face


def compound(*shapes) -> TopoDS_Compound:
    builder, whole = BRep_Builder(), TopoDS_Compound()
    builder.MakeCompound(whole)
    for shape in shapes:
        builder.Add(whole, shape)
    return whole


def write_brep(shape, path) -> None:
    BRepTools.Write_s(shape, str(path))
