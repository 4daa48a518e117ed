"""Lattices along principal directions: where they keep to them, and what triangles are saved."""

import numpy as np
import pytest

import surfmesh as sm
from surfmesh.geometry.differential.fundamental_forms import curvatures, forms
from surfmesh.geometry.files.formula_file import gallery, load_formula_file
from surfmesh.sizing.field.size_law import SizeLaw
from surfmesh.sizing.rules.curvature_size import chord_size, lattice_chord_size
from surfmesh.sizing.rules.principal_lattice import keeps_lattice
from tests.naive import principal_lattice as naive

# a cylinder whose lines u = constant wind around it
SHEARED = sm.ParametricSurface(
    "cos(u + 0.3*v)", "sin(u + 0.3*v)", "v", u=(0.0, 2.0 * np.pi), v=(0.0, 3.0)
)


@pytest.mark.parametrize(
    "name, chord, kept",
    [
        ("cylinder", 1e-3, True),
        ("catenoid", 5e-4, True),  # minimal: chord's metric is flat, its lines straight in it
        ("enneper", 1e-3, True),
        ("cylinder", 0.1, False),  # rims are near everywhere
        ("catenoid", 5e-2, False),
        ("cone", 1e-4, False),  # flat, but lines turn in it by half their angle
        ("torus", 1e-4, False),
        ("sphere", 1e-4, False),
        ("plane", 1e-4, False),
        ("wavy", 1e-4, False),
    ],
)
def test_lattices_are_for_surfaces_on_which_they_keep_their_direction(name, chord, kept):
    assert SizeLaw.of(sm.load(name), sm.Sizing(chord=chord)).is_on_lattice is kept


@pytest.mark.parametrize(
    "other",
    [
        {"anisotropy": 5.0},
        {"vertices": "balanced"},
        {"max_size": 0.02},
        {"size": lambda p: 0.1 + 0.0 * p[:, 0]},
    ],
)
def test_lattices_are_for_isotropic_sizes_by_chord_alone(other):
    law = SizeLaw.of(sm.load("cylinder"), sm.Sizing(chord=1e-3, **other))
    assert not law.is_on_lattice


@pytest.mark.parametrize(
    "name, kept", [("catenoid", True), ("enneper", True), ("torus", False), ("sphere", False)]
)
def test_the_fewest_stretched_triangles_form_lattices_on_flat_saddles(name, kept):
    sizing = sm.Sizing(chord=2e-4, anisotropy=100.0, fewest=True)
    assert SizeLaw.of(sm.load(name), sizing).is_on_lattice is kept


def lattice_angles(surface, mesh):
    """(m,) degrees, -30 to 30, of the edges of triangles from the smaller curvature."""
    uv = mesh.uv.mean(axis=1)
    k = curvatures(forms(surface, uv))
    _, ru, rv = surface.evaluate(uv, 1)
    direction = np.where((np.abs(k.k1) < np.abs(k.k2))[:, None], k.d1, k.d2)
    along = direction[:, :1] * ru + direction[:, 1:] * rv
    normal = np.cross(ru, rv)
    across = np.cross(normal / np.linalg.norm(normal, axis=1)[:, None], along)
    corners = mesh.points[mesh.triangles]
    steps = corners - np.roll(corners, 1, axis=1)
    turn = np.arctan2(np.einsum("mki,mi->mk", steps, across), np.einsum("mki,mi->mk", steps, along))
    return np.degrees(np.angle(np.exp(6j * turn).sum(axis=1))) / 6.0


@pytest.mark.parametrize("surface", [sm.load("cylinder"), SHEARED])
def test_edges_lie_along_the_axis_of_a_cylinder(surface):
    mesh = sm.mesh(surface, sm.Sizing(chord=4e-4))
    assert np.mean(np.abs(lattice_angles(surface, mesh)) < 5.0) > 0.75
    report = sm.check(mesh)
    assert report.clean
    assert len(mesh.triangles) < 1.38 * report.equilateral_triangles  # 1.48 in other directions


def test_edges_lie_between_the_principal_directions_of_a_minimal_surface():
    surface = sm.load("catenoid")
    mesh = sm.mesh(surface, sm.Sizing(chord=2e-4))
    angle = np.abs(lattice_angles(surface, mesh))  # 15 degrees from one is 15 from the other
    assert np.mean((angle > 10.0) & (angle < 20.0)) > 0.7
    report = sm.check(mesh)
    assert report.clean
    assert len(mesh.triangles) < 1.38 * report.equilateral_triangles


def test_large_cylinders_are_packed_from_a_line_along_the_axis():
    surface = sm.load("cylinder")
    mesh = sm.mesh(surface, sm.Sizing(chord=4e-5))  # 50,000 circles are packed in halves
    assert np.mean(np.abs(lattice_angles(surface, mesh)) < 5.0) > 0.9


def test_cylinders_of_models_have_lattices_too():
    cadquery = pytest.importorskip("cadquery")
    solid = cadquery.Workplane("XY").circle(1.0).extrude(3.0)
    mesh = sm.mesh(solid, sm.Sizing(chord=4e-4))
    assert sm.check(mesh).clean
    side = [k for k, surface in enumerate(mesh.surfaces) if surface.kind == "cylinder"]
    part = mesh.submesh(np.isin(mesh.face_ids, side))
    assert np.mean(np.abs(lattice_angles(mesh.surfaces[side[0]], part)) < 5.0) > 0.7


@pytest.mark.parametrize("ratio", [0.3, 0.0, -0.3, -1.0])
def test_only_the_reserve_differs(ratio):
    k = np.array([2.0])
    larger = lattice_chord_size(k, ratio * k, 1e-3) / chord_size(k, ratio * k, 1e-3)
    assert 1.03 < float(larger[0]) < 1.09


@pytest.mark.parametrize("stretched", [{}, {"anisotropy": 100.0, "fewest": True}])
@pytest.mark.parametrize("chord", [1e-2, 1e-3, 1e-4])
@pytest.mark.parametrize("name", gallery())
def test_the_core_finds_lattices_as_the_twin_does(name, chord, stretched):
    surface = load_formula_file(gallery()[name])
    law = SizeLaw.of(surface, sm.Sizing(chord=chord, **stretched))
    rules, extent = law.rules.on_lattice(), law.chart.extent
    assert keeps_lattice(surface, extent, rules) == naive.keeps_lattice(surface, extent, rules)
