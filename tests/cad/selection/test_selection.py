"""Selections on plain models, compared with CadQuery's own."""

import cadquery as cq
import numpy as np
import pytest
from cadquery.selectors import StringSyntaxSelector

import surfmesh as sm
from surfmesh.cad.model.centres import edge_centre, face_centre, solid_centre
from surfmesh.cad.selection.selection import select
from surfmesh.cad.selection.selectors import is_selector, selected
from surfmesh.errors import SizingError

PARTS = {
    "holed": cq.Workplane().box(10, 20, 30).faces(">Z").workplane().hole(4),
    "rounded": cq.Workplane().box(10, 20, 30).edges("|Z").fillet(2),
    "pin": cq.Workplane().cylinder(20, 5).edges(">Z").fillet(1).faces("<Z").chamfer(0.5),
    "sphere": cq.Workplane().sphere(5),
}
SELECTORS = [
    ">Z", "<Z", ">X", ">Z[0]", ">Z[-2]", "<Z[1]", ">>Z[1]", "<<Z[0]", "|Z", "#Z", "+Z", "-Z", "Z",
    "%PLANE", "%cylinder", "%CIRCLE", ">(1,1,0)", "|(0, 1, 0)", "top", "|Z and >Y", "|Z or |X",
    "not |Z", "not |Z and #X", "%PLANE exc |Z", "(|X or |Y) and >Z", "%PLANE except (>Z or <Z)",
]  # fmt: skip


@pytest.fixture(scope="module")
def models():
    return {name: sm.from_cadquery(part) for name, part in PARTS.items()}


@pytest.mark.parametrize("name", PARTS)
@pytest.mark.parametrize("kind", ["face", "edge", "vertex"])
def test_selectors_agree_with_cadquery(models, name, kind):
    shape, model = PARTS[name].val(), models[name]
    shapes = {"face": shape.Faces, "edge": shape.Edges, "vertex": shape.Vertices}[kind]()
    shapes = [s for s in shapes if kind != "edge" or s.Length() > 1e-9]
    centres = {
        "face": lambda k: face_centre(model.faces[k]),
        "edge": lambda k: edge_centre(model.edges[k]),
        "vertex": lambda k: model.vertices[k].point,
    }[kind]
    for text in SELECTORS:
        try:
            wanted = StringSyntaxSelector(text).filter(shapes)
        except (ValueError, IndexError):  # CadQuery has no empty selections here
            wanted = []
        found = selected(model, kind, text)
        assert len(found) == len(wanted), text
        theirs = sorted(tuple(np.round(s.Center().toTuple(), 4) + 0.0) for s in wanted)
        ours = sorted(tuple(np.round(centres(k), 4) + 0.0) for k in found)
        assert np.allclose(theirs, ours, atol=2e-4), text


@pytest.mark.parametrize("name", PARTS)
def test_centres_of_mass(models, name):
    shape, model = PARTS[name].val(), models[name]
    found = solid_centre(model, model.solids[0])
    assert found == pytest.approx(np.array(shape.Center().toTuple()), abs=1e-9)


@pytest.mark.parametrize("text", ["fillet", "front*", "+", "a>b", "12", "X-ray", "not", "-2"])
def test_names_are_no_selectors(text):
    assert not is_selector(text) or text in ("+", "not")


def test_keys():
    assembly = cq.Assembly(name="car")
    assembly.add(cq.Workplane().box(1, 1, 1), name="wheel left", color=cq.Color("red"))
    assembly.add(cq.Workplane().sphere(1), name="wheel right", loc=cq.Location((3, 0, 0)))
    model = sm.from_cadquery(assembly)
    assert select(model, "wheel*").solids == (0, 1)
    assert select(model, "car").solids == (0, 1)
    assert select(model, "solid:wheel l*").solids == (0,)
    assert select(model, "color:#ff0000").faces == select(model, "colour:red").faces
    assert len(select(model, "color:red").faces) == 6
    assert select(model, "type:sphere").faces == (6,)
    assert select(model, "face:0, 2-3").faces == (0, 2, 3)
    assert select(model, "edge:>Z and |X").edges
    assert len(select(model, "vertex:*").vertices) == len(model.vertices)
    assert len(select(model, "*").faces) == 7


def test_tags_are_names():
    part = cq.Workplane().box(1, 2, 3).faces(">Z").tag("lid").end().edges("|Z").tag("posts").end()
    model = sm.from_cadquery(part)
    assert select(model, "lid").faces == select(model, ">Z").faces == select(model, "tag:l*").faces
    assert select(model, "posts").edges == select(model, "edge:|Z").edges


NOTHING = {
    "lidd": "selects nothing of .*; did you mean 'lid'",
    "zzz": "its names are 'lid'",
    "face:6": r"there is no face 6; .* has 6, numbered from 0",
    "color:blue": "none of its faces has a colour",
    "color:bluish": "is no colour",
    "type:torus": "its kinds of faces are 'plane'",
    ">Q": r"no selector of CadQuery \(column 1, at '>Q'\)",
    "(>Z": "a closing bracket is missing",
    ">Z and": r"no selector of CadQuery \(column 7, at its end\)",
    "vertex:lid": "selects nothing",
}


@pytest.mark.parametrize("key", NOTHING)
def test_what_selects_nothing_says_so(key):
    model = sm.from_cadquery(cq.Workplane().box(1, 2, 3).faces(">Z").tag("lid").end())
    with pytest.raises(SizingError, match=NOTHING[key]):
        select(model, key)
