"""Meshes with a wanted number of triangles."""

import cadquery as cq
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

import surfmesh as sm
from surfmesh.errors import MeshingError, SizingError
from surfmesh.meshing.triangle_count import COARSEST, mesh_with_count, sizing_for_count


@pytest.mark.parametrize(
    ("name", "wanted"), [("torus", 3000), ("plane", 500), ("two_peaks", 2000), ("torus", 300)]
)
def test_surface_has_so_many_triangles(name, wanted):
    mesh = sm.mesh(sm.load(name), triangles=wanted)
    assert len(mesh.triangles) == pytest.approx(wanted, rel=0.05)
    assert mesh.sizing.chord is not None  # what it can be held to
    assert not mesh.warnings


def test_model_has_so_many_triangles():
    part = cq.Workplane().box(4, 3, 1).faces(">Z").workplane().hole(1.2)
    mesh = sm.mesh(part, sm.Sizing(triangles=2000, growth=1.5))
    assert len(mesh.triangles) == pytest.approx(2000, rel=0.05)
    assert sm.check(mesh).clean


def test_progress_never_falls():
    told = []
    sm.mesh(sm.load("two_peaks"), triangles=2000, progress=lambda _, done: told.append(done))
    assert told == sorted(told)


def test_sizes_of_everything_of_a_formula():
    mesh = sm.mesh(sm.load("torus"), {"*": sm.Sizing(triangles=2000)})
    assert len(mesh.triangles) == pytest.approx(2000, rel=0.05)


def test_stretched_sizes():
    mesh = sm.mesh(sm.load("torus"), triangles=2000, anisotropy=4.0)
    assert len(mesh.triangles) == pytest.approx(2000, rel=0.05)


def test_too_few_are_said():
    mesh = sm.mesh(cq.Workplane().box(1, 1, 1), triangles=4)
    assert mesh.warnings[-1].startswith("12 triangles, where 4 were asked for: the coarsest sizes")


def test_estimate_and_explain_know_it():
    sizing = sm.Sizing(triangles=5000)
    assert sm.estimate(sm.load("torus"), sizing).triangles == pytest.approx(5000, rel=0.05)
    assert sm.explain(sm.load("torus"), sizing, (3.0, 0.0, 1.0)).size > 0.0


@given(st.integers(50, 10**6), st.floats(10.0, 1e4), st.floats(1.2, 2.4))
@settings(deadline=None)
def test_search_meets_any_power(wanted, factor, power):
    def count(sizing):
        return factor * (sizing.max_size / 0.1) ** -power

    sizing, scales = sizing_for_count(sm.Sizing(triangles=wanted), 1.0, count)
    assert sizing.triangles is None
    assert sizing.chord == pytest.approx(1e-3 * scales.chord**2)
    assert sizing.max_size == pytest.approx(0.1 * scales.size)
    if count(sm.Sizing(max_size=0.1 * COARSEST)) > wanted:
        assert scales.size == COARSEST
    else:
        assert count(sizing) == pytest.approx(wanted, rel=0.021)


@given(st.integers(500, 2900), st.floats(0.002, 0.2), st.floats(0.05, 0.5))
@settings(deadline=None)
def test_search_meets_what_a_jump_leaves_out(wanted, jump, rest):
    """Details vanish at a chord, and with them most triangles: sizes alone make up for them."""

    def count(sizing):
        details = 3000.0 if sizing.chord < jump else 0.0
        return details + rest * 10.0 / sizing.max_size**2

    sizing, _ = sizing_for_count(sm.Sizing(triangles=wanted), 1.0, count)
    assert count(sizing) == pytest.approx(wanted, rel=0.05)


def test_sizes_that_give_no_mesh_are_not_the_end():
    def mesh(sizing):
        if sizing.chord > 0.05:
            raise MeshingError("too coarse")
        return sm.mesh(sm.load("torus"), sizing.replaced(max_size=None))

    estimated = lambda sizing: 1.0 / sizing.chord  # noqa: E731
    made = mesh_with_count(sm.Sizing(triangles=10), 1.0, estimated, mesh)
    assert "coarser sizes give no mesh" in made.warnings[-1]
    with pytest.raises(MeshingError, match="never"):
        mesh_with_count(sm.Sizing(triangles=10), 1.0, estimated, _never)


def _never(sizing):
    raise MeshingError("never")


@pytest.mark.parametrize(
    ("name", "wanted"),
    [("klein", 5000), ("trefoil", 1000), ("ellipsoid", 200), ("letter_a", 5000), ("spring", 5000)],
)
def test_counts_that_stand_still_or_jump_are_met(name, wanted):
    mesh = sm.mesh(sm.load(name), triangles=wanted)
    assert len(mesh.triangles) == pytest.approx(wanted, rel=0.05)
    assert not any("asked for" in warning for warning in mesh.warnings)


def test_flat_faces_are_met_with_stretched_sizes():
    mesh = sm.mesh(cq.Workplane().box(4, 3, 1), triangles=2000, anisotropy=5.0)
    assert len(mesh.triangles) == pytest.approx(2000, rel=0.05)


def test_limit_holds_where_a_trial_goes_beyond():
    mesh = sm.mesh(sm.load("two_peaks"), triangles=2000, limit=2000)
    assert 1900 <= len(mesh.triangles) <= 2000


def test_least_size_is_named_as_the_reason():
    mesh = sm.mesh(sm.load("torus"), triangles=5000, min_size=0.5)
    assert "no finer sizes give more" in mesh.warnings[-1]


def test_it_excludes_other_sizes():
    for other in ({"chord": 0.1}, {"size": 1.0}, {"angle": 20.0}, {"volume": 0.1}):
        with pytest.raises(SizingError, match="give one"):
            sm.Sizing(triangles=100, **other)
    for number in (0, -5, 2.5, float("nan"), "many", 3):
        with pytest.raises(SizingError):
            sm.Sizing(triangles=number)
    with pytest.raises(SizingError, match="limit"):
        sm.Sizing(triangles=1000, limit=100)
    with pytest.raises(SizingError, match="for everything together"):
        sm.mesh(cq.Workplane().box(1, 1, 1), {"*": sm.Sizing(triangles=100), ">Z": 0.1})


def test_options_by_name():
    torus = sm.load("torus")
    by_name = sm.mesh(torus, size=0.6)
    assert (by_name.points == sm.mesh(torus, 0.6).points).all()
    with pytest.raises(SizingError, match="twice"):
        sm.mesh(torus, 0.6, chord=0.1)
    with pytest.raises(SizingError, match="called 'chord'"):
        sm.mesh(torus, hausd=0.1)
    with pytest.raises(SizingError, match="known"):
        sm.mesh(torus, optimize=False)
