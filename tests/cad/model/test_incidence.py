"""A mesh that is what its model is, is clean: edges of more faces than two, fans, tiny edges."""

import cadquery as cq
import numpy as np
import pytest
from OCP.BRep import BRep_Builder
from OCP.BRepBuilderAPI import BRepBuilderAPI_MakeEdge, BRepBuilderAPI_MakeFace
from OCP.Geom import Geom_Circle, Geom_Plane
from OCP.Geom2d import Geom2d_Circle
from OCP.gp import gp_Ax2, gp_Ax22d, gp_Circ, gp_Dir, gp_Dir2d, gp_Pln, gp_Pnt, gp_Pnt2d
from OCP.TopLoc import TopLoc_Location
from OCP.TopoDS import TopoDS_Vertex, TopoDS_Wire
from shapes import box_with_hole, cut_boxes, square_with_inner_edges

import surfmesh as sm
from surfmesh.cad.model.incidence import edge_uses, vertex_fans
from surfmesh.result.surface_mesh import SurfaceMesh

CHORD = sm.Sizing(chord=0.05, max_size=2)


def sheet(*points):
    return cq.Face.makeFromWires(cq.Wire.makePolygon(points, close=True))


def sheets():
    return sheet((0, 0, 0), (5, 0, 0), (5, 5, 0), (0, 5, 0)).fuse(
        sheet((0, 0, 0), (5, 0, 0), (5, -5, 0), (0, -5, 0)),
        sheet((0, 0, 0), (5, 0, 0), (5, 0, 5), (0, 0, 5)),
    )


def box(*at):
    return cq.Workplane().box(2, 2, 2, centered=False).translate(at)


def pits():
    pit = cq.Workplane(obj=cq.Solid.makeCone(4, 0, 5, pnt=cq.Vector(0, 0, -5)))
    down = cq.Vector(0, 0, -1)
    top = cq.Workplane(obj=cq.Solid.makeCone(4, 0, 5, pnt=cq.Vector(0, 0, 5), dir=down))
    return cq.Workplane().box(10, 10, 10).cut(pit).cut(top)


def wedges():
    """Two triangles of one sheet that meet in a corner, and a third along the gap between."""
    return sheet((0, 0, 0), (3, 1, 0), (3, -1, 0)).fuse(
        sheet((0, 0, 0), (-1, 3, 0), (1, 3, 0)), sheet((0, 0, 0), (1, 3, 0), (3, 1, 0))
    )


def plate_touched_by_a_hole():
    """A square with a triangular hole that touches its border in a corner."""
    outer = cq.Wire.makePolygon(
        [(-4, 0, 0), (0, 0, 0), (4, 0, 0), (4, 4, 0), (-4, 4, 0)], close=True
    )
    hole = sheet((0, 0, 0), (1, 2, 0), (-1, 2, 0))
    return cq.Face.makeFromWires(outer).cut(hole)


def crossing_sheets():
    """Four faces along one edge; every figure of their meshes is exact to the last bit."""
    return cq.Face.makePlane(6, 6).fuse(cq.Face.makePlane(6, 6, (0, 0, 0), (1, 0, 0)))


def tube_through_a_sheet():
    tube = cq.Face.makeRuledSurface(
        *(cq.Wire.makeCircle(2, cq.Vector(0, 0, z), cq.Vector(0, 0, 1)).Edges()[0] for z in (0, 5))
    )
    return tube.fuse(cq.Face.makePlane(6, 6, (0, 0, 2.5), (0, 0.3, 1)))


def tangent_cylinders():
    first = cq.Workplane().circle(1).extrude(4)
    return first.union(first.translate((2, 0, 0)))


TOUCHING = {
    "crossing sheets": (crossing_sheets, 4, 1),
    "tube through a sheet": (tube_through_a_sheet, 4, 1),
    "tangent cylinders": (tangent_cylinders, 4, 1),
    "T joint of sheets": (sheets, 3, 1),
    "boxes that share an edge": (lambda: box(0, 0, 0).union(box(2, 2, 0)), 4, 1),
    "boxes that share a corner": (lambda: box(0, 0, 0).union(box(2, 2, 2)), 2, 2),
    "pits that meet in a point": (pits, 2, 2),
    "three sheets in a corner": (wedges, 2, 1),
    "a hole that touches the border": (plate_touched_by_a_hole, 1, 2),
    "boxes that share a face": (cut_boxes, 3, 1),
    "hole": (box_with_hole, 2, 1),
    "slit": (square_with_inner_edges, 2, 1),
}


@pytest.mark.parametrize("name", TOUCHING)
@pytest.mark.parametrize(
    "sizing", [CHORD, sm.Sizing(size=0.7), sm.Sizing(chord=0.05, anisotropy=5)]
)
def test_a_mesh_that_touches_itself_as_its_model_does(name, sizing):
    make, uses, fans = TOUCHING[name]
    model = sm.from_cadquery(make())
    assert max(edge_uses(model)) == uses and max(vertex_fans(model)) == fans
    mesh = sm.mesh(model, sizing)
    report = mesh.report
    assert report.clean, report.problems
    assert report.manifold == (uses <= 2 and fans <= 1)
    assert mesh.connectivity.uses.max() == max(uses, 2)
    assert report.euler == report.euler_exact


def test_volume_of_solids_that_touch_themselves():
    for at in ((2, 2, 0), (2, 2, 2)):
        for turned in (0, 37):
            both = box(0, 0, 0).union(box(*at)).rotate((0, 0, 0), (1, 2, 3), turned)
            report = sm.mesh(sm.from_cadquery(both), 0.7).report
            assert report.closed and not report.manifold
            assert report.volume == pytest.approx(16) and report.volume_error == pytest.approx(0)


def test_what_is_not_in_the_model_is_a_problem():
    mesh = sm.mesh(sm.from_cadquery(cq.Workplane().box(2, 2, 2)), 0.7)
    made = {name: getattr(mesh, name) for name in mesh.__dataclass_fields__}
    third = mesh.triangles[mesh.edges[mesh.connectivity.uses == 2][0, 0]]
    edge = mesh.edges[0]
    far = int(np.linalg.norm(mesh.points - mesh.points[edge[0]], axis=1).argmax())
    made |= {
        "triangles": np.concatenate([mesh.triangles, [(*edge, far)]]),
        "uv_triangles": np.concatenate([mesh.uv_triangles, mesh.uv_triangles[:1]]),
        "face_ids": np.r_[mesh.face_ids, 0], "solid_ids": np.r_[mesh.solid_ids, [(0, -1)]],
    }  # fmt: skip
    said = SurfaceMesh(**made).report.problems
    assert len(third) == 3
    assert any("with more triangles than the model has faces there" in text for text in said), said
    kept = slice(1, None)
    made |= {name: getattr(mesh, name)[kept] for name in ("triangles", "uv_triangles")}
    made |= {name: getattr(mesh, name)[kept] for name in ("face_ids", "solid_ids")}
    assert any("is not closed" in text for text in SurfaceMesh(**made).report.problems)


def face_with_tiny_loop(scale=1.0, own_wire=False, at=(0.0, 0.0)):
    """A square with a closed edge of 6e-6 at a corner, or around a place within it."""
    build, r = BRep_Builder(), 1e-6 * scale

    def vertex(x, y):
        made = TopoDS_Vertex()
        build.MakeVertex(made, gp_Pnt(x * scale, y * scale, 0), 1e-5 * scale)
        return made

    corners = [vertex(*p) for p in ((0, 0), (10, 0), (10, 10), (0, 10))]
    edges = [BRepBuilderAPI_MakeEdge(corners[i], corners[i - 3]).Edge() for i in range(4)]
    start = vertex(*at) if own_wire else corners[0]
    x, y = at[0] * scale + r, at[1] * scale
    axes = gp_Ax2(gp_Pnt(x, y, 0), gp_Dir(0, 0, 1), gp_Dir(-1, 0, 0))
    circle = Geom_Circle(gp_Circ(axes, r))
    loop = BRepBuilderAPI_MakeEdge(circle, start, start, 0.0, 2 * np.pi).Edge()
    pcurve = Geom2d_Circle(gp_Ax22d(gp_Pnt2d(x, y), gp_Dir2d(-1, 0), gp_Dir2d(0, -1)), r)
    build.UpdateEdge(loop, pcurve, Geom_Plane(gp_Pln()), TopLoc_Location(), 1e-12)
    wire = TopoDS_Wire()
    build.MakeWire(wire)
    for edge in [*edges, loop][: 4 if own_wire else 5]:
        build.Add(wire, edge)
    make = BRepBuilderAPI_MakeFace(gp_Pln(), wire, True)
    if own_wire:
        inner = TopoDS_Wire()
        build.MakeWire(inner)
        build.Add(inner, loop)
        make.Add(inner)
    return cq.Shape.cast(make.Face())


@pytest.mark.parametrize("scale", [1e-2, 1.0, 1e3])
def test_euler_number_of_a_face_with_a_tiny_loop(scale):
    model = sm.from_cadquery(face_with_tiny_loop(scale))
    report = sm.mesh(model, 1.0 * scale).report
    assert report.clean and report.euler == report.euler_exact == 1


def test_a_tiny_edge_between_two_corners():
    """A box with a corner cut off by 1e-6: its edge there is one vertex of the mesh."""
    shape = (
        cq.Workplane().polyline([(0, 0), (10, 0), (10, 8), (10 - 1e-6, 8 + 1e-6), (0, 9)]).close()
    )
    model = sm.from_cadquery(shape.extrude(3))
    report = sm.mesh(model, 1.5).report
    assert report.clean and report.euler == report.euler_exact == 2, report.problems
    assert sorted(set(vertex_fans(model))) == [0, 1]
