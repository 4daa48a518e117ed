"""Surfaces that a flexible size is judged by: formulas beside the gallery's, and CAD faces.

The CAD faces are the gallery's shapes once more, for meshers that read no formulas. They are
open where those are: no flat end adds triangles of its own.
"""

import math

import cadquery as cq
import numpy as np

TURN = (0.0, 2.0 * np.pi)
FORMULAS = {
    "tube 50": ("cos(u)", "sin(u)", "v", TURN, (0.0, 50.0)),
    "thin ring": (
        "(10 + 0.5*cos(v))*cos(u)", "(10 + 0.5*cos(v))*sin(u)", "0.5*sin(v)", TURN, TURN,
    ),
    "wing": (
        "(1 - v/16)*u**2 + v/4", "(1 - v/16)*0.18*u*(1 - u**2)*(1 + 0.6*u**2)", "v",
        (-1.0, 1.0), (0.0, 8.0),
    ),
}  # fmt: skip
"""x, y, z and the ranges of u and v."""


def sphere() -> cq.Shape:
    return cq.Workplane().sphere(1.0).val()


def torus() -> cq.Shape:
    return cq.Solid.makeTorus(2.0, 0.7)


def tube() -> cq.Shape:
    """Fifty radii long."""
    return _curved(cq.Solid.makeCylinder(1.0, 50.0))


def cone() -> cq.Shape:
    return _curved(cq.Solid.makeCone(1.0, 0.2, 3.0))


def spring() -> cq.Shape:
    """A round wire along three turns of a helix."""
    path = cq.Wire.makeHelix(0.5, 1.5, 1.0)
    wire = cq.Workplane("XZ").center(1.0, 0.0).circle(0.15)
    return _curved(wire.sweep(cq.Workplane(path), isFrenet=True).val())


def wing() -> cq.Shape:
    """The loft of the formula's section, a closed spline, at the root and at the tip."""
    u = np.linspace(-1.0, 1.0, 41)
    sections = []
    for v in (0.0, 8.0):
        x = (1 - v / 16) * u**2 + v / 4
        y = (1 - v / 16) * 0.18 * u * (1 - u**2) * (1 + 0.6 * u**2)
        points = [cq.Vector(*place, v) for place in zip(x, y)]
        sections.append(cq.Wire.assembleEdges([cq.Edge.makeSpline(points)]))
    return _curved(cq.Solid.makeLoft(sections, True))


SHAPES = {shape.__name__: shape for shape in (sphere, torus, tube, cone, spring, wing)}


def _curved(solid: cq.Shape) -> cq.Shape:
    """All faces of ``solid`` but the flat ones."""
    faces = [face for face in solid.Faces() if face.geomType() != "PLANE"]
    if not faces or not math.isfinite(sum(face.Area() for face in faces)):
        raise ValueError("the shape has no curved face of finite area")
    return faces[0] if len(faces) == 1 else cq.Shell.makeShell(faces)
