"""What the verbs say to options of the wrong kind, and to those that have no effect."""

from concurrent.futures import ThreadPoolExecutor

import cadquery as cq
import numpy as np
import pytest

import surfmesh as sm
from surfmesh.errors import CadError, FileFormatError, SizingError
from surfmesh.sizing.options.given_sizes import idle_options

SADDLE = sm.ParametricSurface("u", "v", "u*v", u=(-1, 1), v=(-1, 1), name="saddle")
NO_TRUTH = (0, 1, None, np.nan, "abc", [True], np.array([True]))


@pytest.fixture(scope="module")
def coarse():
    return sm.mesh(SADDLE, 0.5)


@pytest.mark.parametrize("value", NO_TRUTH, ids=repr)
@pytest.mark.parametrize("name", ["optimise", "strict", "simplify", "proof", "fewest", "gap_faces"])
def test_what_is_no_truth_value_is_refused_by_name(name, value):
    with pytest.raises(SizingError, match=f"^{name} is True or False, not "):
        sm.mesh(SADDLE, **{name: value})


def test_so_it_is_by_the_other_verbs(coarse, tmp_path):
    with pytest.raises(SizingError, match="second_opinion is True or False, not 'no'"):
        sm.check(coarse, second_opinion="no")
    with pytest.raises(SizingError, match="prove is True or False, not 0"):
        coarse.check(prove=0)
    with pytest.raises(SizingError, match="lines is True or False, not nan"):
        sm.Near((0, 0, 0), 0.1, lines=np.nan)
    with pytest.raises(SizingError, match="circles is True or False, not 'no'"):
        coarse.plot(tmp_path / "no.png", circles="no")
    with pytest.raises(FileFormatError, match="ascii is True or False, not 'no'"):
        coarse.save(tmp_path / "no.stl", ascii="no")
    with pytest.raises(CadError, match="isolate is True or False, not 0"):
        sm.load("torus", isolate=0)
    with pytest.raises(CadError, match="heal is True or False, not 0"):
        sm.from_cadquery(None, heal=0)
    with pytest.raises(SizingError, match="optimise is True or False, not 0"):
        sm.mesh_into_pieces(tmp_path / "no.pvtu", None, None, None, optimise=0)


@pytest.mark.parametrize("value", [False, True])
def test_truth_values_of_numpy_are_pythons(value):
    given, own = (
        sm.mesh(SADDLE, chord=0.1, optimise=kind(value), fewest=kind(False))
        for kind in (np.bool_, bool)
    )
    np.testing.assert_array_equal(given.points, own.points)
    assert type(sm.Sizing(proof=np.True_, chord=0.1).proof) is bool


@pytest.mark.parametrize("given", ["nonsense", 2, ThreadPoolExecutor], ids=str)
def test_what_is_no_executor_is_refused_whatever_is_meshed(given, tmp_path):
    said = "^executor is .*: one of concurrent.futures is needed"
    domain = sm.PlanarDomain(outer=[(0, 0), (4, 0), (4, 3)])
    for subject in (SADDLE, domain, cq.Workplane().box(1, 1, 1)):
        with pytest.raises(SizingError, match=said):
            sm.mesh(subject, 0.5, executor=given)
    with pytest.raises(SizingError, match=said):
        sm.mesh_into_pieces(tmp_path / "no.pvtu", None, None, given)


def test_progress_is_a_function():
    with pytest.raises(SizingError, match="progress is 3, no function of"):
        sm.mesh(SADDLE, 0.5, progress=3)


BOX = cq.Workplane().box(1, 1, 1)


@pytest.mark.parametrize("subject", [SADDLE, BOX], ids=["formula", "model"])
def test_options_without_effect_are_said_to_have_none(subject):
    for options, said in (
        (dict(chord=0.1, fewest=True, optimise=False), "fewest has no effect with optimise=False"),
        (dict(size=0.5, anisotropy=5), "anisotropy 5 has no effect with size alone"),
    ):
        mesh = sm.mesh(subject, **options)
        assert [warning.startswith(said) for warning in mesh.warnings] == [True]
        assert mesh.report.clean or not options.get("optimise", True)


def test_options_with_effect_are_not():
    for options in (
        dict(chord=0.1, fewest=True), dict(chord=0.1, size=0.5, anisotropy=5),
        dict(anisotropy=5), dict(triangles=200, anisotropy=5), dict(size=0.5),
    ):  # fmt: skip
        assert sm.mesh(SADDLE, **options).warnings == ()
    by_name = {"*": sm.Sizing(size=0.5, anisotropy=5), "": sm.Sizing(chord=0.1)}
    assert idle_options(by_name, True) == []
    assert len(idle_options({"*": sm.Sizing(size=0.5, anisotropy=5), "faces": 0.5}, True)) == 1
