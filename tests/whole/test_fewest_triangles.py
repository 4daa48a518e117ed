"""Sizing(fewest=True): as few triangles of one size in all directions as keep the chord."""

import numpy as np
import pytest

import surfmesh as sm


def meshes(name: str, **asked: object) -> tuple[sm.SurfaceMesh, sm.SurfaceMesh]:
    """As ever, and with as few triangles as can be."""
    surface = sm.load(name)
    plain, fewest = (sm.mesh(surface, sm.Sizing(fewest=few, **asked)) for few in (False, True))
    return plain, fewest


@pytest.mark.parametrize(
    ("name", "chord", "most"),
    [
        ("torus", 0.004, 0.88),
        ("monkey_saddle", 0.003, 0.88),
        ("cylinder", 0.001, 0.82),
        ("sphere", 0.002, 0.96),
    ],
)
def test_it_takes_fewer_triangles_and_keeps_the_chord(name: str, chord: float, most: float) -> None:
    plain, fewest = meshes(name, chord=chord)
    assert len(fewest.triangles) < most * len(plain.triangles)
    report = sm.check(fewest)
    assert report.clean, report.problems
    assert report.deviation_max <= chord
    assert report.alpha_mean > 0.95
    assert report.alpha_min > 0.6


def test_the_number_of_processes_changes_nothing() -> None:
    surface, sizing = sm.load("torus"), sm.Sizing(chord=0.0005, fewest=True)
    one, two = (sm.mesh(surface, sizing, jobs=jobs) for jobs in (1, 2))
    assert one.points.tobytes() == two.points.tobytes()
    assert np.array_equal(one.triangles, two.triangles)


def test_sizes_that_are_stated_hold() -> None:
    plain, fewest = meshes("torus", chord=0.004, max_size=0.18)
    assert 0.8 < len(fewest.triangles) / len(plain.triangles) < 1.0
    assert fewest.sizes.max() <= 0.18 * 1.005  # vertices move on after sizes were capped


def test_without_a_curve_nothing_changes() -> None:
    plain, fewest = meshes("letter_a", chord=0.01)
    assert plain.points.tobytes() == fewest.points.tobytes()


def test_the_chord_is_kept_where_even_use_does_not_suffice() -> None:
    plain, fewest = meshes("wavy", chord=0.5, growth=4.0)
    assert plain.report.clean and fewest.report.clean
    assert len(fewest.triangles) < 1.03 * len(plain.triangles)


def test_an_angle_is_kept_as_ever() -> None:
    plain, fewest = meshes("torus", chord=0.006, angle=8.0)
    assert plain.points.tobytes() == fewest.points.tobytes()


def test_as_many_as_are_asked_for_keep_a_smaller_chord() -> None:
    plain, fewest = meshes("monkey_saddle", triangles=2000)
    assert abs(len(fewest.triangles) - 2000) <= 100
    assert fewest.sizing.chord < 0.95 * plain.sizing.chord


@pytest.mark.parametrize("also", [{"proof": True}, {"vertices": "balanced"}])
def test_it_keeps_what_else_is_asked_for(also: dict[str, object]) -> None:
    plain, fewest = meshes("torus", chord=0.006, **also)
    assert sm.check(fewest).clean
    assert len(fewest.triangles) < 0.95 * len(plain.triangles)


def test_the_estimate_knows_of_it() -> None:
    surface, sizing = sm.load("torus"), sm.Sizing(chord=0.003, fewest=True)
    made = len(sm.mesh(surface, sizing).triangles)
    assert sm.estimate(surface, sizing).triangles == pytest.approx(made, rel=0.1)
