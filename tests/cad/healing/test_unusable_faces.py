"""Faces that cannot be meshed are named, the rest is delivered; files without faces say what else
they hold."""

import pytest

cq = pytest.importorskip("cadquery")

from OCP.BRep import BRep_Builder  # noqa: E402
from OCP.BRepBuilderAPI import (  # noqa: E402
    BRepBuilderAPI_MakeEdge,
    BRepBuilderAPI_MakeFace,
    BRepBuilderAPI_MakeVertex,
)
from OCP.BRepPrimAPI import BRepPrimAPI_MakeHalfSpace  # noqa: E402
from OCP.BRepTools import BRepTools, BRepTools_ReShape  # noqa: E402
from OCP.Geom import Geom_CylindricalSurface, Geom_Plane  # noqa: E402
from OCP.gp import gp_Ax3, gp_Cylinder, gp_Dir, gp_Lin, gp_Pln, gp_Pnt  # noqa: E402
from OCP.Poly import Poly_Triangle, Poly_Triangulation  # noqa: E402
from OCP.TopAbs import TopAbs_FORWARD, TopAbs_REVERSED  # noqa: E402
from OCP.TopoDS import (  # noqa: E402
    TopoDS_Compound,
    TopoDS_Edge,
    TopoDS_Face,
    TopoDS_Shell,
    TopoDS_Solid,
    TopoDS_Wire,
)

import surfmesh as sm  # noqa: E402
from surfmesh.cad.reading.readers import read_here  # noqa: E402
from surfmesh.cli import main  # noqa: E402
from surfmesh.errors import CadError, MeshingError  # noqa: E402

BUILD = BRep_Builder()


def compound(*shapes):
    made = TopoDS_Compound()
    BUILD.MakeCompound(made)
    for shape in shapes:
        BUILD.Add(made, shape)
    return made


def box():
    return cq.Solid.makeBox(1, 1, 1).wrapped


def triangles_alone():
    mesh, face = Poly_Triangulation(3, 1, False), TopoDS_Face()
    for number, point in enumerate([(0, 0, 0), (1, 0, 0), (0, 1, 0)], 1):
        mesh.SetNode(number, gp_Pnt(*point))
    mesh.SetTriangle(1, Poly_Triangle(1, 2, 3))
    BUILD.MakeFace(face, mesh)
    return face


def box_with_a_side_of_triangles():
    whole, context = box(), BRepTools_ReShape()
    context.Replace(cq.Shape.cast(whole).Faces()[0].wrapped, triangles_alone())
    return context.Apply(whole)


def face_of(surface, *edges):
    face, wire = TopoDS_Face(), TopoDS_Wire()
    BUILD.MakeFace(face, surface, 1e-7)
    BUILD.MakeWire(wire)
    for edge in edges:
        BUILD.Add(wire, edge)
    BUILD.Add(face, wire)
    return face


def no_curves():
    points = [(1, 0, 0), (0, 1, 0), (0, 1, 2)]
    ends = [BRepBuilderAPI_MakeVertex(gp_Pnt(*point)).Vertex() for point in points]
    edges = []
    for start, end in zip(ends, ends[1:] + ends[:1]):
        edge = TopoDS_Edge()
        BUILD.MakeEdge(edge)
        BUILD.Add(edge, start.Oriented(TopAbs_FORWARD))
        BUILD.Add(edge, end.Oriented(TopAbs_REVERSED))
        edges.append(edge)
    return face_of(Geom_CylindricalSurface(gp_Ax3(), 1.0), *edges)


def endless_edges():
    lines = gp_Lin(gp_Pnt(0, 0, 0), gp_Dir(1, 0, 0)), gp_Lin(gp_Pnt(0, 1, 0), gp_Dir(-1, 0, 0))
    return face_of(Geom_Plane(gp_Ax3()), *(BRepBuilderAPI_MakeEdge(line).Edge() for line in lines))


def half_space():
    return BRepPrimAPI_MakeHalfSpace(BRepBuilderAPI_MakeFace(gp_Pln()).Face(), gp_Pnt(0, 0, -1))


UNUSABLE = {
    "triangles alone": (triangles_alone, r"near \(0\.33333, .*no surface, but 1 triangle; export"),
    "no edges": (lambda: BRepBuilderAPI_MakeFace(gp_Pln()).Face(), "no edges, .* to infinity"),
    "an empty loop": (lambda: face_of(Geom_Plane(gp_Ax3())), "no edges, .* to infinity; trim"),
    "an endless cylinder": (
        lambda: BRepBuilderAPI_MakeFace(gp_Cylinder(gp_Ax3(), 1.0)).Face(), "goes on to infinity",
    ),
    "edges without curves": (no_curves, "an edge of it has no curve, neither in space nor on"),
    "endless edges": (endless_edges, "an edge of it goes on to infinity; trim it"),
    "half a space": (lambda: half_space().Solid(), "goes on to infinity; trim it"),
}  # fmt: skip


@pytest.mark.parametrize("name", UNUSABLE)
def test_a_face_that_cannot_be_used(name):
    make, reason = UNUSABLE[name]
    alone = f"holds no face that can be meshed: the only face.*{reason}"
    with pytest.raises(CadError, match=alone):
        sm.from_cadquery(make())
    model = sm.from_cadquery(compound(make(), box()))
    assert model.broken_invariant() == "" and len(model.faces) == 6
    assert model.volume == pytest.approx(1.0)
    with pytest.raises(MeshingError, match=rf"face 1 of 7.*{reason}.*strict=False"):
        sm.mesh(model, 1.0)
    mesh = sm.mesh(model, 1.0, strict=False)
    report = sm.check(mesh)
    assert len(mesh.triangles) == 12 and not report.clean
    assert report.problems[0].startswith("not meshed: face 1 of 7 in")


def test_a_solid_with_a_face_that_cannot_be_used():
    model = sm.from_cadquery(box_with_a_side_of_triangles())
    assert model.broken_invariant() == "" and len(model.faces) == 5 and len(model.left_out) == 1
    assert model.area == pytest.approx(5.0)
    assert "left out: face 1 of 6" in model.summary()


@pytest.mark.parametrize("make", [TopoDS_Solid, TopoDS_Shell, TopoDS_Compound])
def test_what_is_empty_is_no_obstacle(make):
    empty = make()
    {
        TopoDS_Solid: BUILD.MakeSolid, TopoDS_Shell: BUILD.MakeShell,
        TopoDS_Compound: BUILD.MakeCompound,
    }[make](empty)  # fmt: skip
    model = sm.from_cadquery(compound(empty, box()))
    assert model.broken_invariant() == "" and len(model.solids) == 1 and model.left_out == ()
    with pytest.raises(CadError, match="holds no faces"):
        sm.from_cadquery(empty)


def test_a_name_tells_which_face_it_is():
    both = cq.Shape.cast(compound(triangles_alone(), box()))
    whole = cq.Assembly(name="skin").add(both, name="a")
    (said,) = sm.from_cadquery(whole).left_out
    assert said.startswith("face 1 of 7 in 'a' near (0.33333, 0.33333, 0): ")


def test_exit_status(tmp_path, capsys):
    path, out = tmp_path / "both.brep", tmp_path / "out.vtu"
    BRepTools.Write_s(compound(triangles_alone(), box()), str(path))
    given = ["mesh", str(path), "-o", str(out), "--size", "1"]
    assert main(given) == 2 and not out.exists()
    assert "no surface, but 1 triangle" in capsys.readouterr().err
    assert main([*given, "--no-strict"]) == 1 and out.exists()


def step_of(shape, path, replaced=()):
    """A STEP file of a shape, with some of its text replaced."""
    cq.exporters.export(cq.Workplane(cq.Shape.cast(shape)), str(path))
    text = path.read_text()
    for old, new in replaced:
        assert old in text
        text = text.replace(old, new)
    path.write_text(text)


def iges_of(path, *entities):
    """An IGES file of (type, parameters), each on one line."""
    head = "1H,,1H;,4Hpart,8Hpart.igs,4Hhand,4Hhand,32,38,6,308,15,4Hpart,1.,2,2HMM,1,0.01,"
    tail = "15H20240101.000000,1E-06,100.,4Hhand,4Hhand,11,0,15H20240101.000000;"
    lines = [f"{'':72}S{1:>7}", f"{head[:72]:72}G{1:>7}", f"{head[72:] + tail[:50]:72}G{2:>7}",
             f"{tail[50:]:72}G{3:>7}"]  # fmt: skip
    for number, (kind, _) in enumerate(entities):
        zeros = f"{0:>8}" * 6
        lines.append(f"{kind:>8}{number + 1:>8}{zeros}00000000D{2 * number + 1:>7}")
        lines.append(f"{kind:>8}{0:>8}{0:>8}{1:>8}{0:>8}{'':24}{0:>8}D{2 * number + 2:>7}")
    for number, (kind, values) in enumerate(entities):
        text = f"{kind},{','.join(map(str, values))};"
        lines.append(f"{text:64}{2 * number + 1:>8}P{number + 1:>7}")
    count = len(entities)
    lines.append(f"S{1:>7}G{3:>7}D{2 * count:>7}P{count:>7}{'':40}T{1:>7}")
    path.write_text("\n".join(lines) + "\n")


LINE = (110, (0.0, 0.0, 0.0, 1.0, 0.0, 0.0))
BLOCK = (150, (1.0, 2.0, 3.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 0.0, 1.0))
TUBE = (154, (3.0, 1.0, 0.0, 0.0, 0.0, 0.0, 0.0, 1.0))


def brep_solid(text):
    """The line of the only solid of a STEP file of a box."""
    return next(line for line in text.splitlines() if "MANIFOLD_SOLID_BREP" in line)


def test_iges_files_without_faces(tmp_path):
    for name, entities, words in (
        ("lines", [LINE, LINE], "only 2 curves: .* make faces of the curves"),
        ("csg", [BLOCK, TUBE], r"only 2 CSG entities: .* evaluate them .* \(B-rep\)"),
        ("both", [BLOCK, LINE], "only 1 CSG entity, 1 curve: "),
        ("note", [(212, (0,))], "only 1 note or drawing: there is nothing to mesh"),
    ):
        path = tmp_path / f"{name}.igs"
        iges_of(path, *entities)
        with pytest.raises(CadError, match=f"{name}.igs holds no faces, {words}"):
            read_here(path, True, None)


def test_step_files_without_faces(tmp_path):
    path = tmp_path / "part.step"
    step_of(cq.Edge.makeLine(cq.Vector(0, 0, 0), cq.Vector(1, 2, 3)).wrapped, path)
    with pytest.raises(CadError, match=r"part\.step holds no faces, only 1 curve: "):
        read_here(path, True, None)
    step_of(box(), path)
    solid = brep_solid(path.read_text())
    number = solid.split("=")[0].strip()
    frame = "#11"
    for body, words in (
        (f"CSG_SOLID('',#9001);\n#9001=BLOCK('',{frame},1.,2.,3.);", "only 2 CSG entities: "),
        ("EXTRUDED_AREA_SOLID('',#9002,#9003,2.);", "only 1 swept solid: "),
    ):
        step_of(box(), path, [(solid, f"{number} = {body}")])
        with pytest.raises(CadError, match=f"holds no faces, {words}"):
            read_here(path, True, None)
    triangles = (
        f"{number} = TESSELLATED_SOLID('',(#9010),$);\n"
        "#9010=TRIANGULATED_FACE('',#9011,3,((0.,0.,1.)),$,(),((1,2,3)));\n"
        "#9011=COORDINATES_LIST('',3,((0.,0.,0.),(1.,0.,0.),(0.,1.,0.)));"
    )
    step_of(box(), path, [
        (solid, triangles), ("ADVANCED_BREP_SHAPE_REP", "TESSELLATED_SHAPE_REP"),
    ])  # fmt: skip
    with pytest.raises(CadError, match=r"only 1 tessellated shape: .*no surface, but 1 triangle"):
        read_here(path, True, None)


def test_a_body_of_csg_beside_a_solid_is_named(tmp_path):
    path = tmp_path / "part.step"
    step_of(box(), path)
    solid = brep_solid(path.read_text())
    more = f"#9002=CSG_SOLID('',#9001);\n#9001=BLOCK('',#11,1.,2.,3.);\n{solid}"
    step_of(box(), path, [(solid, more)])
    model = read_here(path, True, None)
    assert len(model.faces) == 6
    assert model.left_out[0].startswith("2 CSG entities besides: not read")


def test_brep_files_without_faces(tmp_path):
    path = tmp_path / "part.brep"
    wire = cq.Wire.makePolygon([(0, 0, 0), (1, 0, 0), (1, 1, 0)], close=True)
    corner = BRepBuilderAPI_MakeVertex(gp_Pnt(1, 2, 3)).Vertex()
    empty = TopoDS_Solid()
    BUILD.MakeSolid(empty)
    for shape, words in (
        (wire.wrapped, "only 3 curves: there is nothing to mesh; make faces of the curves"),
        (compound(corner, wire.wrapped), "only 3 curves, 1 point: "),
        (corner, "only 1 point: there is nothing to mesh"),
        (empty, "only 1 solid without faces: "),
        (compound(), "and nothing else: "),
    ):
        BRepTools.Write_s(shape, str(path))
        with pytest.raises(CadError, match=rf"part\.brep holds no faces,? ?{words}"):
            read_here(path, True, None)
