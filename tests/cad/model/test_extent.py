"""How large a model is: faces that bulge beyond their edges count."""

import math
from dataclasses import replace

import numpy as np
import pytest

pytest.importorskip("OCP")

from OCP.BRepPrimAPI import BRepPrimAPI_MakeBox, BRepPrimAPI_MakeSphere, BRepPrimAPI_MakeTorus

from surfmesh.cad.conversion.model_of_parts import model_of
from surfmesh.cad.model.extent import diagonal
from surfmesh.cad.parts import Part

SHAPES = {
    "box": (lambda: BRepPrimAPI_MakeBox(1.0, 2.0, 2.0).Shape(), 3.0),
    "sphere": (lambda: BRepPrimAPI_MakeSphere(2.0).Shape(), 4.0 * math.sqrt(3.0)),
    "torus": (lambda: BRepPrimAPI_MakeTorus(3.0, 1.0).Shape(), math.hypot(8.0, 8.0, 2.0)),
}


@pytest.mark.parametrize("name", SHAPES)
def test_diagonal(name):
    made, exact = SHAPES[name]
    model = model_of(Part(name, made()), heal=True)
    assert model.diagonal == pytest.approx(exact, rel=1e-12)


def test_what_lies_outside_the_loops_does_not_count():
    model = model_of(Part("sphere", BRepPrimAPI_MakeSphere(2.0, 0.0, 0.5).Shape()), heal=True)
    wide = [replace(f, surface=f.surface.with_domain(((0.0, math.tau), (-1.5, 1.5))))
            if f.kind == "sphere" else f for f in model.faces]  # fmt: skip
    assert diagonal(model.vertices, model.edges, wide) == pytest.approx(model.diagonal, rel=1e-2)
    assert np.isfinite(model.diagonal)
