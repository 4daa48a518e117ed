"""Features narrower than the triangles: found, or said not to be excluded; and no false alarms."""

import numpy as np
import pytest

import surfmesh as sm
from surfmesh._core.space import triangle_distances


def height(z, u=(0, 1), v=(0, 1)):
    return sm.ParametricSurface("u", "v", z, u=u, v=v)


@pytest.mark.parametrize("by_size", [True, False])
@pytest.mark.parametrize("scale", [1e-3, 1.0, 1e3])
@pytest.mark.parametrize("width, place", [(1e-5, (0.5137, 0.4871)), (1e-6, (0.0713, 0.9137))])
def test_a_spike_between_all_samples_is_found_with_its_place(width, place, scale, by_size):
    a, b = place
    z = f"{scale}*exp(-((u/{scale}-{a})**2+(v/{scale}-{b})**2)/{width}**2)"
    surface = height(z, (0, scale), (0, scale))
    chord = sm.Sizing(chord=0.02 * scale, min_size=0.05 * scale)
    asked = sm.Sizing(size=0.07 * scale) if by_size else chord
    report = sm.check(sm.mesh(surface, asked))
    assert not report.clean and report.unseen > 0
    first = report.unseen_at[0]
    assert first.found and np.allclose(first.uv, [scale * a, scale * b], atol=5 * width * scale)
    assert report.unseen_max == first.deviation == pytest.approx(scale, rel=1e-3)
    assert any("missing" in problem for problem in report.problems)


@pytest.mark.parametrize(
    "x, y",
    [
        ("u", "v + 0.3*exp(-((u-0.513)/1e-5)**2)"),  # the rims swing out in their own plane
        ("u + 0.2*exp(-((v-0.487)/1e-4)**2)", "v"),
    ],
)
def test_a_tongue_of_a_rim_is_found(x, y):
    surface = sm.ParametricSurface(x, y, "0", u=(0, 1), v=(0, 1))
    report = sm.check(sm.mesh(surface, sm.Sizing(size=0.1)))
    assert not report.clean and report.unseen >= 2


@pytest.mark.parametrize("z", ["sign(u-0.3)", "tanh(1e6*(u-0.3))", "floor(2*u+0.1)"])
def test_a_step_is_never_clean(z):
    try:
        report = sm.check(sm.mesh(height(z), sm.Sizing(size=0.2, min_size=0.05)))
    except sm.errors.SurfmeshError:
        return
    assert not report.clean


@pytest.mark.parametrize(
    "z",
    ["0", "0.3*sin(3*u)*cos(2*v)", "u**2*v", "0.1*exp(-(u**2+v**2)/0.3**2)", "0.2*sqrt(u+v+0.01)",
     "0.1*cos(3*atan2(v-0.5, u-2))"],
)  # fmt: skip
@pytest.mark.parametrize(
    "asked", [{"chord": 3e-3}, {"size": 0.1}, {"chord": 0.01, "anisotropy": 5}]
)
def test_smooth_surfaces_are_proved_to_hide_nothing(z, asked):
    report = sm.check(sm.mesh(height(z), sm.Sizing(**asked)))
    assert report.clean and report.unseen == 0 and report.unseen_at == ()
    assert "nothing more between the samples" in " ".join(str(report).split())


def test_of_a_function_the_report_says_that_it_has_no_bounds():
    surface = sm.NumericSurface(lambda u, v: (u, v, u * v), u=(0, 1), v=(0, 1))
    report = sm.check(sm.mesh(surface, sm.Sizing(size=0.2)))
    assert report.clean and report.unseen is None and report.functions == 1
    assert "a function has no bounds" in " ".join(str(report).split())


def test_distance_of_points_from_triangles():
    rng = np.random.default_rng(7)
    corners, points = rng.normal(size=(40, 3, 3)), 2.0 * rng.normal(size=(40, 3))
    share = np.linspace(0.0, 1.0, 161)
    s, t = (x.ravel() for x in np.meshgrid(share, share))
    weights = np.stack([1 - s - t, s, t], axis=1)[s + t <= 1.0]
    samples = np.einsum("wk,nki->nwi", weights, corners)
    nearest = np.linalg.norm(samples - points[:, None], axis=2).min(axis=1)
    found = triangle_distances(points, corners)
    assert (found <= nearest + 1e-12).all() and found == pytest.approx(nearest, abs=0.02)


def test_a_pyramid_as_steep_as_a_wall_is_meshed():
    """Its sizes creep up the walls for 27 million cells times sweeps, and get there."""
    z = "max(0,1-1000*abs(u-0.513))*max(0,1-1000*abs(v-0.487))"
    made = sm.mesh(sm.ParametricSurface("u", "v", z, u=(0, 1), v=(0, 1)), sm.Sizing(chord=0.01))
    assert made.report.clean and made.points[:, 2].max() > 0.99


def test_a_sheared_cylinder_is_bounded_by_narrow_boxes():
    """In (u, v) its triangles are slivers aslant: boxes have to be as narrow as these."""
    sheared = sm.ParametricSurface(
        "cos(u+20*v)", "sin(u+20*v)", "v", u=(0, "2*pi"), v=(0, 1)
    )  # fmt: skip
    assert sm.check(sm.mesh(sheared, size=0.1)).clean
