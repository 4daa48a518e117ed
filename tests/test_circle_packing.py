"""``sm.pack``: section 2 of the paper alone, over the unbounded plane."""

import json

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.spatial import cKDTree

import surfmesh as sm
from surfmesh.circle_packing import CirclePacking
from surfmesh.cli import main
from surfmesh.errors import FileFormatError, SizingError

PAPER_AVG1, PAPER_AVG3 = 0.151276, 0.823691  # Table 2, random sizes 1 : 1000
STATED_OVERLAP = 0.02


def touching(packing: CirclePacking) -> np.ndarray:
    """d / (r1 + r2) of every pair of circles that might overlap."""
    pairs = cKDTree(packing.centres).query_pairs(2 * packing.radii.max(), output_type="ndarray")
    i, j = pairs.T
    d = np.linalg.norm(packing.centres[i] - packing.centres[j], axis=1)
    return d / (packing.radii[i] + packing.radii[j])


@pytest.mark.parametrize("hi", [100.0, 1000.0])
def test_random_radii_are_valid_for_a_hundred_seeds(hi):
    overlapping, shapes, ratios = 0, [], []
    for seed in range(100):
        packing = sm.pack(sm.UniformRadius(1.0, hi, seed=seed), count=1000)
        assert packing.broken_invariant() is None
        l = touching(packing)
        assert l.min() > 0.75
        overlapping += np.count_nonzero(l < 1.0 - STATED_OVERLAP - 1e-9)
        shapes.append(packing.statistics.alpha_mean)
        ratios.append(packing.statistics.size_error_mean)
    assert overlapping <= 10  # of the 100,000 circles
    assert np.mean(shapes) >= PAPER_AVG3
    assert np.mean(ratios) <= PAPER_AVG1


def test_radii_are_those_of_the_law():
    drawn = sm.pack(sm.UniformRadius(2.0, 5.0, seed=3), count=5000).wanted
    assert drawn.min() >= 2.0 and drawn.max() <= 5.0
    assert drawn.mean() == pytest.approx(3.5, abs=0.03)
    assert np.quantile(drawn, 0.25) == pytest.approx(2.75, abs=0.06)


def test_the_same_seed_gives_the_same_packing_to_the_last_bit():
    first, again = (sm.pack(sm.UniformRadius(1, 50, seed=9), count=2000) for _ in range(2))
    assert (first.centres == again.centres).all() and (first.triangles == again.triangles).all()
    other = sm.pack(sm.UniformRadius(1, 50, seed=10), count=2000)
    assert (first.centres != other.centres).any()


def test_growing_arrays_changes_nothing():
    # a distance does not say how many circles there will be: arrays grow on the way
    by_distance = sm.pack(sm.UniformRadius(1, 10, seed=1), distance=1000.0)
    by_count = sm.pack(sm.UniformRadius(1, 10, seed=1), count=18_000)
    assert len(by_distance.centres) > 18_000
    assert (by_distance.centres[:18_000] == by_count.centres).all()


def test_a_constant_radius_gives_the_hexagonal_packing():
    packing = sm.pack(0.5, count=3000)
    figures = packing.statistics
    assert packing.broken_invariant() is None
    assert figures.alpha_min == pytest.approx(1.0)
    assert figures.size_error_max == pytest.approx(0.0, abs=1e-9)
    assert figures.nodes == 3000
    assert figures.elements == 2 * 3000 - 2 - len(packing.front)  # Euler


def test_columns_of_the_paper_keep_their_names_in_json_and_warn_as_attributes():
    figures = sm.pack(0.5, count=10).statistics
    assert figures.to_dict()["max1"] == figures.size_error_max
    assert list(figures.to_dict())[:4] == ["nodes", "elements", "max1", "avg1"]
    with pytest.warns(DeprecationWarning, match="avg3 is called alpha_mean"):
        assert figures.avg3 == figures.alpha_mean


def test_a_radius_law_is_followed():
    def law(p):
        return 0.2 + 0.02 * np.hypot(p[:, 0], p[:, 1])

    packing = sm.pack(law, origin=(3.0, 4.0), distance=40.0)
    assert packing.broken_invariant() is None
    assert packing.wanted == pytest.approx(law(packing.centres), rel=0.03)
    assert packing.statistics.size_error_mean < 0.02 and packing.statistics.alpha_mean > 0.95
    far = np.linalg.norm(packing.centres - (3.0, 4.0), axis=1)
    assert far.min() < 0.5 and 38.0 < far.max() < 45.0


def test_a_tensor_field_gives_ellipses():
    def tensors(p):
        return np.tile([[4.0, 1.0], [1.0, 1.0]], (len(p), 1, 1))

    packing = sm.pack(sm.TensorField(tensors), count=500)
    assert packing.broken_invariant() is None
    assert packing.statistics.alpha_min == pytest.approx(1.0)  # in the metric
    assert packing.radii == pytest.approx(np.sqrt(3.0) / 2.0)


def test_a_box_is_filled():
    packing = sm.pack(1.0, box=(-10.0, -5.0, 30.0, 40.0))
    border = packing.centres[packing.front]
    inside = (border > [-10.0, -5.0]).all(axis=1) & (border < [30.0, 40.0]).all(axis=1)
    assert not inside.any()
    assert len(packing.centres) > 40 * 45 / (2 * np.sqrt(3.0))


@settings(max_examples=20)
@given(
    seed=st.integers(0, 2**31),
    ratio=st.sampled_from([1.0, 3.0, 1e3, 1e6]),
    scale=st.sampled_from([1e-9, 1.0, 1e9]),
    count=st.integers(3, 400),
)
def test_any_random_law_is_valid(seed, ratio, scale, count):
    packing = sm.pack(sm.UniformRadius(scale, ratio * scale, seed=seed), count=count)
    assert packing.broken_invariant() is None
    assert len(packing.centres) == count


@pytest.mark.parametrize(
    ("radius", "limits", "said"),
    [
        (1.0, {}, "give count, distance or box"),
        (-1.0, {"count": 10}, "positive number"),
        ("wide", {"count": 10}, "positive number"),
        (1.0, {"count": 2}, "from 3"),
        (1.0, {"distance": 0.0}, "positive"),
        (1.0, {"box": (1.0, 0.0, 0.0, 1.0)}, "x0 < x1"),
        (1.0, {"box": (1.0, 1.0, 2.0, 2.0)}, "outside the box"),
        (lambda p: p[:, 0], {"count": 10}, "positive numbers"),
        (lambda p: 0.1 + (p**2).sum(axis=1), {"count": 10_000}, "does not hold"),
        (sm.TensorField(lambda p: np.tile([1.0, 2.0, 1.0], (len(p), 1))), {"count": 9}, "definite"),
    ],
)
def test_what_makes_no_sense_is_refused(radius, limits, said):
    with pytest.raises(SizingError, match=said):
        sm.pack(radius, **limits)


def test_random_radii_must_be_positive():
    with pytest.raises(SizingError, match="0 < lo <= hi"):
        sm.UniformRadius(5.0, 1.0)


def test_drawings(tmp_path):
    packing = sm.pack(sm.UniformRadius(1, 10), count=50)
    for name in ("both.svg", "both.png"):
        assert packing.plot(tmp_path / name).stat().st_size > 1000
    assert packing.plot(tmp_path / "circles.svg", "circles").stat().st_size > 1000
    with pytest.raises(FileFormatError, match=r"\.svg or \.png"):
        packing.plot(tmp_path / "a.pdf")
    with pytest.raises(SizingError, match="show"):
        packing.plot(tmp_path / "a.svg", "everything")


def test_command_line(tmp_path, capsys):
    drawing = tmp_path / "circles.svg"
    words = ["pack", "--uniform", "1", "100", "--count", "200", "-o", str(drawing), "--json"]
    assert main(words) == 0
    said = json.loads(capsys.readouterr().out)
    assert said["nodes"] == 200 and said["problem"] is None and drawing.exists()
    assert main(["pack", "--radius", "1"]) == 2
    assert "give count, distance or box" in capsys.readouterr().err


@pytest.mark.parametrize(
    "radii",
    [lambda n: np.zeros(n), lambda n: np.full(n, np.inf), lambda n: np.ones(n - 1)],
    ids=["none", "infinite", "too few"],
)
def test_a_random_law_that_gives_no_radii_is_refused(radii):
    class Law:
        def stream(self):
            return lambda n: np.ones(n) if n == 1000 else radii(n)

    with pytest.raises(SizingError, match=r"the random law must give \d+ positive radii"):
        sm.pack(Law(), count=100)
