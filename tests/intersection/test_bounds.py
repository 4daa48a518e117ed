"""Boxes hold what they are said to hold, cones the normals: against dense samples."""

import numpy as np
import pytest

import surfmesh as sm
from surfmesh.geometry.cad_surfaces.curves import Hyperbola
from surfmesh.geometry.cad_surfaces.elementary import Cone, Cylinder, Plane, Sphere, Torus
from surfmesh.geometry.cad_surfaces.nurbs import BSplineCurve, BSplineSurface
from surfmesh.geometry.cad_surfaces.offset import OffsetSurface
from surfmesh.geometry.cad_surfaces.swept import ExtrusionSurface, RevolutionSurface
from surfmesh.intersection.bounds import are_known, boxes_and_cones
from surfmesh.intersection.sheets import as_model

RNG = np.random.default_rng(5)
FRAME = {
    "origin": np.array([0.3, -0.2, 0.1]), "x": np.array([0.6, 0.8, 0.0]),
    "y": np.array([-0.8, 0.6, 0.0]), "z": np.array([0.0, 0.0, 1.0]),
}  # fmt: skip
BOX = ((0.1, 4.0), (-1.2, 1.3))


def spline(weights):
    knots_u = np.array([0, 0, 0, 0, 1.3, 2.0, 2.0, 4.5, 4.5, 4.5, 4.5])
    knots_v = np.array([-2, -2, -2, 0.3, 2, 2, 2])
    grid = np.meshgrid(np.arange(7.0), np.arange(4.0), indexing="ij")
    control = np.stack([*grid, np.zeros((7, 4))], axis=-1) + 0.5 * RNG.normal(size=(7, 4, 3))
    return BSplineSurface(
        domain=BOX, knots_u=knots_u, knots_v=knots_v, control=control,
        weights=RNG.uniform(0.5, 2.0, (7, 4)) if weights else None,
    )  # fmt: skip


def profile(weights):
    control = np.array([[3.0, 0, -1], [3.5, 0.5, 0.2], [2.5, 1, 0.6], [4, -0.3, 1.5], [3, 0, 2.0]])
    return BSplineCurve(
        np.array([-2, -2, -2, -2, 0.4, 5, 5, 5, 5.0]), control,
        RNG.uniform(0.5, 2.0, 5) if weights else None,
    )  # fmt: skip


BRANCH = Hyperbola(FRAME["origin"], FRAME["x"], FRAME["y"], 1.2, 0.7)
AXIS = {"origin": FRAME["origin"], "axis": np.array([0.6, 0.0, 0.8])}
SURFACES = {
    "plane": Plane(domain=BOX, **FRAME),
    "cylinder": Cylinder(domain=BOX, radius=1.5, **FRAME),
    "cone": Cone(domain=BOX, radius=1.5, angle=0.4, **FRAME),
    "sphere": Sphere(domain=BOX, radius=1.5, **FRAME),
    "torus": Torus(domain=BOX, radius=2.5, tube=0.7, **FRAME),
    "spline": spline(False),
    "rational spline": spline(True),
    "extrusion": ExtrusionSurface(domain=BOX, curve=profile(True), direction=FRAME["x"]),
    "extruded hyperbola": ExtrusionSurface(domain=BOX, curve=BRANCH, direction=FRAME["z"]),
    "revolution": RevolutionSurface(domain=BOX, curve=profile(False), **AXIS),
    "offset torus": OffsetSurface(
        domain=BOX, basis=Torus(domain=BOX, radius=2.5, tube=0.7, **FRAME), distance=0.3
    ),
    "offset spline": OffsetSurface(domain=BOX, basis=spline(True), distance=0.1),
    "formula": as_model(sm.load("wavy"), "wavy").faces[0].surface,
}


def cells(surface, count=200):
    low, high = np.array(surface.domain).T
    a, b = low + RNG.uniform(size=(2, count, 2)) * (high - low)
    middle, half = a, 0.5 * np.abs(b - a) * RNG.uniform(0.01, 1.0, (count, 1))
    return np.clip(middle - half, low, high), np.clip(middle + half, low, high)


@pytest.mark.parametrize("name", SURFACES)
def test_second_derivatives_keep_within_their_bounds(name):
    surface = SURFACES[name]
    assert are_known(surface)
    lo, hi = cells(surface)
    bound = surface.core.derivative_magnitudes(lo, hi)[:, 3:]
    for t in RNG.uniform(size=(50, 1, 2)):
        second = surface.evaluate(lo + t * (hi - lo), 2)[3:]
        for k in range(3):
            assert (np.abs(second[k]) <= bound[:, k] * (1.0 + 1e-9) + 1e-9).all()


@pytest.mark.parametrize("name", SURFACES)
def test_boxes_hold_the_surface_and_cones_its_normals(name):
    surface = SURFACES[name]
    lo, hi = cells(surface)
    boxes, cones = boxes_and_cones(surface, lo, hi)
    for t in RNG.uniform(size=(50, 1, 2)):
        r, r_u, r_v = surface.evaluate(lo + t * (hi - lo), 1)
        assert (r >= boxes.low).all() and (r <= boxes.high).all()
        normal = np.cross(r_u, r_v)
        normal /= np.linalg.norm(normal, axis=1)[:, None]
        cosine = np.clip(np.einsum("ij,ij->i", normal, cones.axis), -1.0, 1.0)
        narrow = cones.angle < 0.49 * np.pi
        assert (np.arccos(cosine)[narrow] <= cones.angle[narrow] + 1e-7).all()
