"""Euler numbers of CAD models, which follow from topology alone, and areas."""

import itertools

import cadquery as cq
import pytest
from OCP.BRepBuilderAPI import (
    BRepBuilderAPI_MakeEdge,
    BRepBuilderAPI_MakeFace,
    BRepBuilderAPI_MakeVertex,
    BRepBuilderAPI_MakeWire,
)
from OCP.gp import gp_Pln, gp_Pnt
from scipy.special import ellipe
from shapes import (
    bare_sphere,
    box_with_hole,
    circle_without_vertex,
    cut_boxes,
    cylinder_without_seam,
    square_with_inner_edges,
)

import surfmesh as sm
from surfmesh.cad.cadquery.from_cadquery import from_cadquery
from surfmesh.cad.model.facts import euler_number, model_facts

# surfaces of genus g: 2 - 2 g; with a border less one for each loop
NUMBERS = {
    "box with a hole": (box_with_hole, 0),
    "sphere": (lambda: cq.Workplane().sphere(1), 2),
    "bare sphere": (bare_sphere, 2),
    "torus": (lambda: cq.Workplane().add(cq.Solid.makeTorus(3, 1)), 0),
    "cone": (lambda: cq.Workplane().add(cq.Solid.makeCone(2, 0, 3)), 2),
    "cylinder": (lambda: cq.Workplane().cylinder(2, 1), 2),
    "band": (cylinder_without_seam, 0),
    "disc": (circle_without_vertex, 1),
    "slit square": (square_with_inner_edges, 1),
    "hollow": (lambda: cq.Workplane().sphere(3).cut(cq.Workplane().sphere(1)), 4),
    "boxes that share a face": (cut_boxes, 3),
}


@pytest.mark.parametrize("name", NUMBERS)
def test_euler_number(name):
    make, expected = NUMBERS[name]
    model = from_cadquery(make())
    assert euler_number(model, range(len(model.faces))) == expected


def test_facts_of_two_solids():
    facts = model_facts(from_cadquery(cut_boxes()))
    assert [solid.euler for solid in facts.solids] == [2, 2]
    assert sorted(solid.volume for solid in facts.solids) == pytest.approx([1, 2])
    assert facts.area == pytest.approx(15) and facts.volume == pytest.approx(3)
    assert facts.euler == 3 and {face.kind for face in facts.faces} == {"plane"}


def test_area_of_an_ellipse_that_is_extruded():
    """Adaptive integration of the CAD kernel gives 1.6 % less and says it was exact."""
    model = from_cadquery(cq.Workplane().ellipse(10, 6).extrude(20))
    side = next(face for face in model.faces if face.kind == "extrusion")
    assert side.area == pytest.approx(20 * 40 * ellipe(1 - 0.6**2), rel=1e-4)


def face_of_loops(*loops):
    """A face in z = 0 whose loops share vertices where corners (x, y) are the same."""
    corners = itertools.chain(*loops)
    vertices = {(x, y): BRepBuilderAPI_MakeVertex(gp_Pnt(x, y, 0)).Vertex() for x, y in corners}
    wires = []
    for loop in loops:
        make = BRepBuilderAPI_MakeWire()
        for ends in zip(loop, loop[1:] + loop[:1]):
            make.Add(BRepBuilderAPI_MakeEdge(*(vertices[end] for end in ends)).Edge())
        wires.append(make.Wire())
    face = BRepBuilderAPI_MakeFace(gp_Pln(), wires[0], True)
    for wire in wires[1:]:
        face.Add(wire)
    return cq.Face(face.Face())


SQUARE = [(0, 0), (2, 0), (4, 0), (4, 2), (4, 4), (2, 4), (0, 4), (0, 2)]
NEXT_TO_IT = [(4, 4), (5, 4), (5, 5), (4, 5)]
LOOPS_THAT_MEET = {
    "two outer loops": ((SQUARE, NEXT_TO_IT), 1),
    "a ring of three": (
        ([(0, 0), (1, 0), (0, 1)], [(1, 0), (2, 0), (1.5, 1)], [(0, 1), (1.5, 1), (1.5, 2)]), 0,
    ),
    "a hole once": ((SQUARE, [(0, 0), (1, 2), (2, 1)]), 0),
    "a hole twice": ((SQUARE, [(0, 0), (1, 2), (4, 4), (2, 1)]), 0),
    "a hole four times": ((SQUARE, [(2, 0), (0, 2), (2, 4), (4, 2)]), 0),
    "two holes": (
        ([(-1, -1), (5, -1), (5, 5), (-1, 5)], [(0, 0), (0, 1), (1, 1), (1, 0)],
         [(1, 1), (1, 2), (2, 2), (2, 1)]), -1,
    ),
    "a hole and an island": (
        ([(-1, -1), (5, -1), (5, 5), (-1, 5)], [(0, 0), (0, 2), (2, 2), (2, 0)],
         [(0, 0), (0.8, 0.1), (0.1, 0.8)]), 0,
    ),
    "an outer loop, another and a hole": ((SQUARE, [(4, 4), (3, 2), (2, 3)], NEXT_TO_IT), 0),
    "a hole and its island at the rim": (
        (SQUARE, [(4, 4), (3, 1), (1, 3)], [(4, 4), (2, 3), (3, 2)]), 0,
    ),
}  # fmt: skip


@pytest.mark.parametrize("name", LOOPS_THAT_MEET)
def test_euler_number_of_a_face_whose_loops_meet_in_a_vertex(name):
    loops, expected = LOOPS_THAT_MEET[name]
    report = sm.mesh(from_cadquery(face_of_loops(*loops), heal=False), size=1.0).report
    assert report.clean and report.euler == report.euler_exact == expected
