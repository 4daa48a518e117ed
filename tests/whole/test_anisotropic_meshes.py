"""Meshes that are longer along the direction of low curvature: how few triangles, how good."""

from functools import cache

import cadquery as cq
import numpy as np
import pytest
from naive.metric import metric_root_3d

import surfmesh as sm
from surfmesh.quality.measures.shape import metric_alpha

TURN = (0.0, 2 * np.pi)
TUBE = sm.ParametricSurface("cos(u)", "sin(u)", "v", u=TURN, v=(0, 50))
RING = sm.ParametricSurface(
    "(10 + 0.5*cos(v))*cos(u)", "(10 + 0.5*cos(v))*sin(u)", "0.5*sin(v)", u=TURN, v=TURN
)
# a tapered, swept wing: both surfaces in one, from the trailing edge round the nose and back;
# round nose (y ~ sqrt x) and thickness as the four-digit NACA sections have them
WING = sm.ParametricSurface(
    "(1 - v/16)*u**2 + v/4", "(1 - v/16)*0.18*u*(1 - u**2)*(1 + 0.6*u**2)", "v", u=(-1, 1), v=(0, 8)
)


def rod():
    return cq.Workplane().circle(1).extrude(50)


def fillets():
    return cq.Workplane().box(20, 10, 5).edges().fillet(1)


def upright_fillets():
    return cq.Workplane().box(40, 20, 10).edges("|Z").fillet(2)


@cache
def meshed(name, ratio, growth=1.2):
    surface, chord = {
        "tube": (TUBE, 0.0021),
        "ring": (RING, 0.01),
        "spring": (sm.load("spring"), 0.001),
        "wing": (WING, 0.0005),
        "two_peaks": (sm.load("two_peaks"), 0.002),
        "ellipsoid": (sm.load("ellipsoid"), 0.002),
        "mobius": (sm.load("mobius"), 0.001),
        "cone": (sm.load("cone"), 0.001),
        "rod": (rod(), 0.0021),
        "fillets": (fillets(), 0.005),
        "upright fillets": (upright_fillets(), 0.04),
    }[name]
    if not isinstance(surface, sm.ParametricSurface):
        surface = sm.from_cadquery(surface)
    mesh = sm.mesh(surface, sm.Sizing(chord=chord, anisotropy=ratio, growth=growth))
    return mesh, sm.check(mesh)


def good(report):
    """Within the chord, unfolded, and good in the wanted metric."""
    assert report.clean, report.problems
    assert report.deviation_max <= report.chord
    assert report.folded == 0
    assert report.manifold and report.components == 1
    assert report.alpha_metric_mean > 0.9 or report.triangles < 200
    assert report.quasi_unit_share > 0.9


@pytest.mark.parametrize("ratio, most", [(100.0, 600), (500.0, 150)])
def test_side_of_a_long_cylinder(ratio, most):
    """49 segments round keep to the chord, so 98 triangles are the least there can be."""
    _, report = meshed("tube", ratio)
    good(report)
    assert 98 <= report.triangles <= most
    assert report.euler == 0 and report.boundary_loops == 2


def test_fillets_between_round_corners_grow_from_them():
    """Sizes grow from the corners along the fillets as everywhere: the faster, the fewer."""
    _, isotropic = meshed("fillets", 1.0, 1.5)
    _, report = meshed("fillets", 10.0, 1.5)
    good(report)
    assert 3.8 * report.triangles <= isotropic.triangles
    assert report.alpha_metric_mean > 0.95 and report.alpha_metric_min > 0.6


def test_planes_beside_fillets_are_as_long_as_they_are():
    """Two triangles a segment of the arcs, and strips on the planes between them."""
    mesh, report = meshed("upright fillets", 20.0)
    good(report)
    kinds = np.array([face.kind for face in mesh.surfaces])[mesh.face_ids]
    assert (kinds == "cylinder").sum() <= 48
    upright = np.isin(mesh.face_ids, [k for k in range(10) if _is_upright(mesh, k)])
    assert upright.sum() <= 240
    assert report.alpha_metric_mean > 0.93 and report.alpha_metric_min > 0.5


def _is_upright(mesh, face):
    return mesh.surfaces[face].kind == "plane" and np.ptp(
        mesh.points[mesh.triangles[mesh.face_ids == face]][..., 2]
    ) > 1.0  # fmt: skip


@pytest.mark.parametrize("ratio, most", [(100.0, 600), (500.0, 150)])
def test_side_of_a_long_cad_cylinder(ratio, most):
    mesh, report = meshed("rod", ratio)
    good(report)
    assert report.closed and report.euler == 2
    side = [k for k, face in enumerate(mesh.surfaces) if face.kind == "cylinder"]
    assert 98 <= np.isin(mesh.face_ids, side).sum() <= most


@pytest.mark.parametrize(
    "name, ratio, times", [
        ("tube", 10.0, 9.0), ("ring", 5.0, 3.5), ("spring", 5.0, 3.5), ("spring", 100.0, 3.3),
        ("wing", 20.0, 18.0), ("wing", 100.0, 60.0), ("two_peaks", 20.0, 2.8),
        ("ellipsoid", 10.0, 1.28), ("mobius", 10.0, 1.55), ("cone", 20.0, 2.2),
        ("fillets", 10.0, 2.7),
    ],
)  # fmt: skip
def test_fewer_triangles_within_the_same_chord(name, ratio, times):
    _, isotropic = meshed(name, 1.0)
    assert isotropic.clean, isotropic.problems
    assert isotropic.alpha_metric_mean is None
    _, report = meshed(name, ratio)
    good(report)
    assert times * report.triangles <= isotropic.triangles
    assert report.euler == isotropic.euler


def test_the_metric_of_the_result():
    """Lengths along and round the tube are as wanted, though they differ a hundredfold."""
    mesh, report = meshed("tube", 100.0)
    sizes = 1 / np.linalg.eigvalsh([metric_root_3d(w) for w in mesh.metric_root_3d])
    np.testing.assert_allclose(sizes[:, 0], 100 * sizes[:, 1], rtol=1e-6)
    np.testing.assert_allclose(1 / mesh.metric_root_3d[:, 5], sizes[:, 0], rtol=1e-6)
    np.testing.assert_allclose(sizes[:, 1].min(), mesh.sizes.min(), rtol=1e-6)
    assert report.alpha_mean < 0.1 < 0.95 < report.alpha_metric_mean
    assert metric_alpha(mesh).min() == report.alpha_metric_min
    assert 0.9 < report.length_mean < 1.1


def test_ratio_one_is_the_isotropic_mesh():
    surface = sm.load("torus")
    plain, one = (
        sm.mesh(surface, {"chord": 0.01}),
        sm.mesh(surface, {"chord": 0.01, "anisotropy": 1.0}),
    )
    np.testing.assert_array_equal(plain.points, one.points)
    assert one.metric_root_3d is None


@pytest.mark.parametrize("make", [lambda: sm.load("two_peaks"), lambda: sm.from_cadquery(rod())])
def test_the_same_mesh_twice(make):
    first, second = (sm.mesh(make(), sm.Sizing(chord=0.01, anisotropy=8.0)) for _ in range(2))
    np.testing.assert_array_equal(first.points, second.points)
    np.testing.assert_array_equal(first.triangles, second.triangles)


@pytest.mark.parametrize("factor", [1e-6, 1e6])
def test_units_do_not_matter(factor):
    tube = sm.ParametricSurface(
        "s*cos(u)", "s*sin(u)", "s*v", u=TURN, v=(0, 50), parameters={"s": factor}
    )
    scaled = sm.mesh(tube, sm.Sizing(chord=0.0021 * factor, anisotropy=100.0))
    assert len(scaled.triangles) == len(meshed("tube", 100.0)[0].triangles)


def test_an_angle_alone_stretches_too():
    """``angle`` binds the turn of the normal, which along a tube is none."""
    mesh = sm.mesh(TUBE, sm.Sizing(angle=10.0, anisotropy=50.0))
    coarse = sm.mesh(TUBE, sm.Sizing(angle=10.0, max_size=5.0))
    report = sm.check(mesh)
    assert report.clean and 20 * report.triangles < len(coarse.triangles)
