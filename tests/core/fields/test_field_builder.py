"""Size fields built from laws of one's own: accuracy, balance, joints, and what is refused."""

import numpy as np
import pytest
from naive.sources import is_balanced, leaves

from surfmesh._core.fields import FieldBuilder
from surfmesh.sizing.field.size_law import FieldNodes

OPEN = [-1] * 4, [False] * 4
NOTHING = np.empty((0, 3), np.int64)


def law_of(size):
    """A plane with sizes size(x, y)."""

    def law(xy):
        n = len(xy)
        h = size(*xy.T)
        point = np.column_stack([xy, np.zeros(n)])
        normal = np.tile([0.0, 0.0, 1.0], (n, 1))
        return FieldNodes.isotropic(h, h, np.tile([1.0, 0.0, 1.0], (n, 1)), normal, point)

    return law


def nothing_hides(deep, low, *_):
    return np.zeros(len(low), bool)


def builder_of(grid=(4, 4), **changed):
    step = tuple(1.0 / max(n, 1) for n in grid)
    plan = dict(
        grid=grid, extent=(1.0, 1.0), root_step=step, slope=0.2,
        largest=16.0, sides=OPEN, sources=NOTHING, known_sizes=False,
        counts_triangles=True, free_cells=200_000, most_triangles=np.inf,
        looks_for_hidden=(False, False),
    )  # fmt: skip
    return FieldBuilder(**(plan | changed))


def built(size, **changed):
    builder = builder_of(**changed)
    assert builder.refine(law_of(size), nothing_hides)[0] == "done"
    return builder.background()


def test_smooth_sizes_are_met():
    """Bilinear in 1 / h, twice as fine as the cells that were tested."""

    def size(x, y):
        return 0.03 * np.exp(0.5 * np.sin(3 * x) + x * y)

    field = built(size, slope=9.0)
    xy = np.random.default_rng(1).uniform(0, 1, (5000, 2))
    np.testing.assert_allclose(field.scalar_sizes(xy), size(*xy.T), rtol=0.02)


def test_sizes_with_a_kink_are_met():
    """A kink between two test nodes is seen less well."""

    def size(x, y):
        return 0.03 * (1.0 + 3.0 * np.abs(x - 0.37)) * np.exp(0.5 * y)

    field = built(size, slope=9.0)
    xy = np.random.default_rng(1).uniform(0, 1, (5000, 2))
    error = np.abs(field.scalar_sizes(xy) / size(*xy.T) - 1.0)
    assert np.quantile(error, 0.98) < 0.02
    assert error.max() < 0.03


def test_a_coarse_field_has_fewer_cells_and_about_the_same_area():
    def size(x, y):
        return 0.03 * np.exp(np.sin(9 * x) + x * y)

    fine, coarse = (built(size, slope=9.0, coarseness=times) for times in (1.0, 4.0))
    assert 2 * len(coarse.child) < len(fine.child)
    assert coarse.metric_area(1.0, 1.0) == pytest.approx(fine.metric_area(1.0, 1.0), rel=0.01)
    with pytest.raises(ValueError, match="coarseness"):
        builder_of(coarseness=0.5)


def test_a_dent_is_graded_and_the_tree_balanced():
    def size(x, y):
        return np.where(np.hypot(x - 0.4, y - 0.3) < 0.03, 0.004, 0.1)

    field = built(size, grid=(64, 64))
    assert is_balanced(leaves(field))
    xy = np.random.default_rng(2).uniform(0, 1, (4000, 2))
    away = np.maximum(np.hypot(xy[:, 0] - 0.4, xy[:, 1] - 0.3) - 0.03, 0.0)
    graded = np.minimum(0.004 + 0.2 * away, 0.1)
    ratio = field.scalar_sizes(xy) / graded
    assert np.median(ratio) == pytest.approx(1.0, abs=0.06)
    assert ratio.max() < 1.6 and ratio.min() > 0.7  # the rim of the dent lies between nodes


def test_joined_sides_are_graded_across():
    def size(x, y):
        return np.where(x < 0.1, 0.01, 1.0)

    shut = built(size, slope=0.1)
    joined = built(size, slope=0.1, sides=([-1, 3, -1, 1], [False] * 4))
    far = np.array([[0.95, 0.5]])
    assert shut.scalar_sizes(far)[0] > 0.08
    assert joined.scalar_sizes(far)[0] < 0.01 + 0.1  # side to side is no distance in this plane


def test_sources_have_cells_of_their_depth():
    source = np.array([[(1 << 20) + 5, 7, 9]])
    field = built(lambda x, y: 0.1 + 0 * x, sources=source)
    found = leaves(field)
    x, y = (source[0, :2] + 0.5) / (4 << 20)
    here = (found[:, 0] <= x) & (x < found[:, 0] + found[:, 2])
    here &= (found[:, 1] <= y) & (y < found[:, 1] + found[:, 3])
    assert found[here, 2] == pytest.approx(0.25 / 2**10)  # once more at the end
    assert is_balanced(found)


def test_cells_that_hide_something_are_split():
    asked = []

    def hides(deep, low, high, normal, root, smallest):
        asked.append(deep)
        assert len(low) == len(high) == len(normal) == len(root) / 9 == len(smallest)
        return (low <= 0.3).all(axis=1) & (high >= 0.3).all(axis=1)

    builder = builder_of(looks_for_hidden=(True, False))
    assert builder.refine(law_of(lambda x, y: 0.1 + 0 * x), hides)[0] == "done"
    found = leaves(builder.background())
    assert found[:, 2].min() == pytest.approx(0.25 / 2**7) and not any(asked)


def test_too_many_triangles_are_told_of_with_their_place():
    builder = builder_of(grid=(330, 330), most_triangles=1e3)
    status, place, number = builder.refine(
        law_of(lambda x, y: 1e-3 + 0.1 * np.hypot(x - 0.7, y - 0.2)), nothing_hides
    )
    assert status == "too_many_triangles" and number > 1e3
    assert place == pytest.approx((0.7, 0.2), abs=0.01)


def test_what_a_law_raises_is_raised():
    def law(xy):
        raise ZeroDivisionError("none of these")

    with pytest.raises(ZeroDivisionError, match="none of these"):
        builder_of().refine(law, nothing_hides)


@pytest.mark.parametrize(
    "law",
    [
        lambda xy: None,
        lambda xy: law_of(lambda x, y: 1 + x)(xy)[:11],
        lambda xy: law_of(lambda x, y: 1 + x)(xy[:-1]),
        lambda xy: law_of(lambda x, y: 1 + x)(xy)._replace(long=np.ones(len(xy))),
        lambda xy: law_of(lambda x, y: 1 + x)(xy)._replace(normal="none"),
    ],
)
def test_laws_that_return_what_does_not_fit_are_refused(law):
    with pytest.raises((ValueError, TypeError)):
        builder_of().refine(law, nothing_hides)


@pytest.mark.parametrize(
    "changed",
    [
        dict(grid=(0, 1)),
        dict(grid=(1 << 11, 1 << 11)),
        dict(sides=([1, -1, -1, -1], [False] * 4)),
        dict(sides=([7, -1, -1, -1], [False] * 4)),
        dict(sources=np.array([[4 << 20, 0, 1]])),
        dict(sources=np.array([[0, -1, 1]])),
        dict(sources=np.array([[0, 0, 21]])),
    ],
)
def test_plans_that_do_not_fit_are_refused(changed):
    with pytest.raises(ValueError):
        builder_of(**changed)


def test_nothing_is_made_of_what_is_not_refined():
    with pytest.raises(ValueError, match="not refined"):
        builder_of().background()
