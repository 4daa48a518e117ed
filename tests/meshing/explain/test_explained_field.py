"""explain says the size that the field has, and the rule that the field follows."""

from functools import cache

import cadquery as cq
import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

import surfmesh as sm
from surfmesh.geometry.differential.sides import find_sides
from surfmesh.meshing.estimate.unmeshed_model import UnmeshedModel
from surfmesh.meshing.explain.axis_sizes import LOWERED, Principal, field_axes
from surfmesh.meshing.faces.face_mesh import face_field
from surfmesh.sizing.field.size_field import size_field
from surfmesh.sizing.field.size_law import SizeLaw
from surfmesh.sizing.rules.rim_rule import Rims

SURFACES = ("helicoid", "ellipsoid", "cylinder", "hyperbolic_paraboloid", "monkey_saddle")
SIZES = (
    {"chord": 0.02}, {"chord": 0.3, "growth": 3.0}, {"angle": 15.0}, {"size": 0.2},
    {"chord": 0.01, "size": 0.3, "growth": 1.1}, {"chord": 0.02, "max_size": 0.15}, {},
    {"chord": 0.01, "angle": 20.0, "min_size": 0.2}, {"chord": 0.5, "max_size": 5.0},
)  # fmt: skip
RATIOS = (1.0, 6.0)


@cache
def fields(name, row, ratio):
    surface, sizing = sm.load(name), sm.Sizing(**SIZES[row], anisotropy=ratio)
    sides = find_sides(surface)
    rims = Rims(surface, sides)
    field = size_field(surface, sizing, sides, rims=rims)
    return surface, sizing, field, SizeLaw.of(surface, sizing, None, rims)


@settings(max_examples=25)
@given(
    st.sampled_from(SURFACES), st.integers(0, len(SIZES) - 1), st.sampled_from(RATIOS),
    st.floats(0.02, 0.98), st.floats(0.02, 0.98), st.sampled_from(["inside", "rim"]),
)  # fmt: skip
def test_on_surfaces_of_the_gallery(name, row, ratio, a, b, where):
    surface, sizing, field, law = fields(name, row, ratio)
    low, high = np.transpose(surface.domain)
    uv = low + np.array([1.0 if where == "rim" else a, b]) * (high - low)
    found = sm.explain(surface, sizing, surface.evaluate(uv[None], 0)[0][0])
    assert found.distance < 1e-6
    xy = field.chart.to_plane(uv[None])
    if not found.axes:
        size = field.sizes(xy)
        assert found.size == pytest.approx(size[0], rel=1e-3)
        assert found.target_size == pytest.approx(law(xy).size[0], rel=1e-3)
        assert found.size <= 1.05 * found.target_size
        if not found.origin:
            assert found.winner.size == pytest.approx(found.target_size, rel=1e-3)
            assert found.size >= LOWERED * found.target_size
        return
    axes = field_axes(field, uv, Principal.at(surface, uv))
    assert [axis.size for axis in found.axes] == pytest.approx([s for s, _ in axes], rel=1e-3)
    for axis in found.axes:
        assert axis.target_size == pytest.approx(min([row.size for row in axis.rows
                                               if row.bound != "min"]), rel=1e-3) or any(
            row.bound == "min" for row in axis.rows
        )  # fmt: skip


@pytest.fixture(scope="module")
def part():
    block = cq.Workplane().box(20, 20, 8).edges("|Z").fillet(3).faces(">Z").workplane().hole(6)
    return sm.from_cadquery(block)


@pytest.mark.parametrize("sizes", [{"chord": 0.05}, {"chord": 1.5, "growth": 2.0}, {"angle": 20.0}])
def test_on_a_cad_part(part, sizes):
    sizing = sm.Sizing(**sizes)
    jobs = UnmeshedModel(part, sizing).jobs
    rng = np.random.default_rng(3)
    for number in range(len(part.faces)):
        surface, field = face_field(jobs[number])
        law = field.law.without_limits()
        mesh_uv = np.concatenate([piece.uv for loop in jobs[number].loops for piece in loop])
        uv = mesh_uv[rng.integers(len(mesh_uv))]  # on an edge: sure to belong to the face
        size = field.sizes(field.chart.to_plane(uv[None]))
        found = sm.explain(part, sizing, surface.evaluate(uv[None], 0)[0][0])
        if found.face == number:
            assert found.size == pytest.approx(size[0], rel=0.01)
            asked = law(law.chart.to_plane(uv[None])).size[0]
            assert found.target_size == pytest.approx(asked, rel=1e-3)


def test_the_default_angle_is_the_rule_of_the_field():
    tube = sm.ParametricSurface("cos(u)", "sin(u)", "v", u=(0, 3.0), v=(0, 3.0), name="tube")
    sizing = sm.Sizing(chord=0.5, max_size=10.0, growth=3)
    found = sm.explain(tube, sizing, (np.cos(1.5), np.sin(1.5), 1.5))
    assert found.size == pytest.approx(found.target_size)
    assert found.size == pytest.approx(1.0203, rel=1e-4)
    assert found.winner.rule.startswith("angle 45 degrees") and found.winner.key == "default"


def test_a_saddle_has_the_default_angle_of_normals():
    """0.320 was said, of the rule for dihedral angles; sizes follow normals: r 1 at its middle."""
    saddle = sm.ParametricSurface("u", "v", "(u^2 - v^2)/2", u=(-1, 1), v=(-1, 1), name="saddle")
    found = sm.explain(saddle, sm.Sizing(chord=1.0, max_size=10.0, growth=3), (0, 0, 0))
    assert found.target_size == found.winner.size
    assert found.target_size == pytest.approx(np.sqrt(3) * 0.75 * np.pi / 4, rel=1e-6)


def test_order_2_without_a_chord_is_explained_by_the_sizes_it_is_meshed_with():
    """It was explained by those of quadratic triangles, which need a chord of one's own."""
    saddle = sm.ParametricSurface("u", "v", "u**2 - v**2", u=(-1, 1), v=(-1, 1))
    straight = sm.explain(saddle, sm.Sizing(), (0, 0, 0))
    assert str(sm.explain(saddle, sm.Sizing(order=2), (0, 0, 0))) == str(straight)


def test_a_rim_says_that_it_decides():
    surface = sm.load("helicoid")
    corner = surface.evaluate(np.array([[surface.domain[0][1], 1.0]]), 0)[0][0]
    for ratio in (1.0, 5.0):
        found = sm.explain(surface, sm.Sizing(chord=4e-4, anisotropy=ratio), corner)
        assert "the rim's own curvature" in found.winner.rule
