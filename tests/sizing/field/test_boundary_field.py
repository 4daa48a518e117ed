"""Fields of planes and cylinders from boundary sizes, against the general ones."""

import numpy as np
import pytest
from naive.sources import graded_sizes

from surfmesh.errors import SizingError
from surfmesh.geometry.cad_surfaces.elementary import Cylinder, Plane, Sphere
from surfmesh.geometry.differential.chart import Chart
from surfmesh.geometry.planar.planar_domain import PlanarDomain
from surfmesh.sizing.field.boundary_field import boundary_field
from surfmesh.sizing.field.size_field import size_field
from surfmesh.sizing.options.sizing import Sizing
from surfmesh.sizing.rules.curvature_size import chord_size

FRAME = dict(origin=np.array([1.0, 2.0, 3.0]), x=np.eye(3)[1], y=np.eye(3)[2], z=np.eye(3)[0])
PLANE = Plane(domain=((-1.0, 2.0), (5.0, 7.0)), **FRAME)
CYLINDER = Cylinder(domain=((-0.5, 1.5), (0.0, 8.0)), radius=4.0, **FRAME)
NOWHERE = np.empty((0, 2)), np.empty(0)


def everywhere(field, n=500):
    return np.random.default_rng(1).uniform(0, 1, (n, 2)) * field.chart.extent


@pytest.mark.parametrize("surface", [PLANE, CYLINDER])
def test_chart_is_the_sampled_one(surface):
    field, sampled = boundary_field(surface, Sizing(size=1.0), *NOWHERE), Chart.of(surface)
    uv = np.random.default_rng(2).uniform(*np.transpose(surface.domain), (20, 2))
    np.testing.assert_allclose(field.chart.extent, sampled.extent)
    np.testing.assert_allclose(field.chart.to_plane(uv), sampled.to_plane(uv), atol=1e-12)
    np.testing.assert_allclose(field.chart.rates(uv), sampled.rates(uv))
    np.testing.assert_allclose(field.chart.to_uv(field.chart.to_plane(uv)), uv)


@pytest.mark.parametrize("surface", [PLANE, CYLINDER])
def test_sizes_grow_along_the_surface(surface):
    rng = np.random.default_rng(3)
    uv = rng.uniform(*np.transpose(surface.domain), (12, 2))
    given = rng.uniform(0.05, 0.2, 12)
    sizing = Sizing(max_size=0.5, chord=10.0, angle=90.0, growth=1.2)
    field = boundary_field(surface, sizing, uv, given)
    xy = everywhere(field)
    exact = graded_sizes(xy, field.chart.to_plane(uv), given, 0.5, sizing.gradient)
    np.testing.assert_allclose(field.sizes(xy), exact, rtol=0.07)
    # unit tensors: the scaled plane has the surface's own metric
    tensor = field.tensors(xy)
    np.testing.assert_allclose(tensor[:, [0, 2]], field.sizes(xy)[:, None] * np.ones(2))
    assert (tensor[:, 1] == 0.0).all()


@pytest.mark.parametrize(
    "options",
    [dict(), dict(chord=0.01), dict(angle=10.0), dict(chord=0.01, max_size=0.1),
     dict(chord=1e-5, min_size=0.3), dict(size=0.7), dict(size=0.7, chord=0.001)],
)  # fmt: skip
@pytest.mark.parametrize("surface", [PLANE, CYLINDER])
def test_the_largest_size_is_that_of_the_general_field(surface, options):
    sizing = Sizing(**options)
    field, general = boundary_field(surface, sizing, *NOWHERE), size_field(surface, sizing)
    assert field.sizing == general.sizing
    xy = everywhere(field, 50)
    np.testing.assert_allclose(field.sizes(xy), general.sizes(xy), rtol=1e-9)
    assert field.expected_vertices() == pytest.approx(general.expected_vertices(), abs=1)


def test_the_largest_size_given_binds_cylinders_together_with_their_curvature():
    sizing = Sizing(chord=0.01)
    by_chord = float(chord_size(np.array([0.25]), np.zeros(1), 0.01)[0])
    coarse = boundary_field(CYLINDER, sizing, *NOWHERE, largest=100.0)
    fine = boundary_field(CYLINDER, sizing, *NOWHERE, largest=0.1)
    assert coarse.sizes(np.ones((1, 2))) == pytest.approx(min(by_chord, 1.0))
    assert fine.sizes(np.ones((1, 2))) == pytest.approx(0.1)


def test_a_planar_domain():
    domain = PlanarDomain([[0, 0], [2, 0], [2, 1], [0, 1]])
    uv, given = np.array([[0.0, 0.0], [2.0, 1.0]]), np.array([0.01, 0.05])
    field = boundary_field(domain, Sizing(size=0.2), uv, given)
    assert field.sizes(uv) == pytest.approx(given, rel=0.05)


def test_expected_vertices_are_the_integral_of_the_density():
    uv, given = np.array([[0.0, 6.0]]), np.array([0.01])
    field = boundary_field(PLANE, Sizing(size=0.2), uv, given)
    xy = everywhere(field, 400_000)
    density = (field.sizes(xy) ** -2.0).mean() * np.prod(field.chart.extent)
    assert field.expected_vertices() - 100 == pytest.approx(2 / np.sqrt(3) * density, rel=0.03)


@pytest.mark.parametrize("given", [[0.0], [-1.0], [np.nan], [1.0, 2.0]])
def test_sizes_that_are_no_sizes(given):
    with pytest.raises(SizingError, match="positive"):
        boundary_field(PLANE, Sizing(size=1.0), np.zeros((1, 2)), np.array(given))


def test_a_metric_that_changes_is_refused():
    sphere = Sphere(domain=((0.0, 1.0), (0.0, 1.0)), radius=1.0, **FRAME)
    with pytest.raises(SizingError, match="size_field"):
        boundary_field(sphere, Sizing(size=1.0), *NOWHERE)


def test_a_size_law_is_refused():
    with pytest.raises(SizingError, match="law"):
        boundary_field(PLANE, Sizing(size=lambda r: np.ones(len(r))), *NOWHERE)


@pytest.mark.parametrize("largest", [-1.0, np.nan, np.inf])
def test_a_largest_size_that_is_none(largest):
    with pytest.raises(SizingError, match="largest"):
        boundary_field(PLANE, Sizing(size=1.0), *NOWHERE, largest=largest)


def test_min_size_binds_sources():
    uv = np.array([[0.0, 6.0]])
    field = boundary_field(PLANE, Sizing(min_size=0.1, max_size=0.5), uv, np.array([0.001]))
    assert field.sizes(field.chart.to_plane(uv)) == pytest.approx(0.1, rel=0.05)
