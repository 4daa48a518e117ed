"""What a user may ask for, and what is refused, with the reason."""

import math

import numpy as np
import pytest

from surfmesh.errors import SizingError
from surfmesh.sizing.options.given_sizes import sizes_of_order
from surfmesh.sizing.options.sizing import Sizing

REFUSED = {
    "chord": (dict(chord=0.0), "chord must be a positive number, not 0"),
    "negative": (dict(angle=-3), "angle must be a positive number, not -3"),
    "text": (dict(min_size="small"), "min_size must be a positive number, not 'small'"),
    "nan": (dict(max_size=math.nan), "max_size must be a positive number, not nan"),
    "infinite": (dict(size=math.inf), "size must be a positive number, not inf"),
    "list": (dict(chord=[1]), r"chord must be a positive number, not \[1\]"),
    "growth of 1": (dict(growth=1.0), "growth must be above 1, not 1"),
    "growth": (dict(growth=None), "growth must be a positive number, not None"),
    "anisotropy": (dict(anisotropy=0.5), "anisotropy must be at least 1"),
    "sources": (dict(sources=(1,)), "sources are Near, InBall, .* or callables"),
    "gap": (dict(gap=0), "gap must be a positive number, not 0"),
    "limit": (dict(limit=-1), "limit must be a positive number, not -1"),
    "angle": (dict(angle=91), "angle must be at most 90 degrees, not 91"),
    "order": (dict(min_size=2, max_size=1), "min_size 2 is larger than max_size 1"),
    "below": (dict(size=1, min_size=2), "size 1 is below min_size 2"),
    "true order": (dict(order=True), "order is True: meshes are of order 1 or 2"),
    "complex order": (dict(order=2 + 0j), r"order is \(2\+0j\): meshes are of"),
    "many triangles": (dict(triangles=1e300), r"^triangles 1e\+300 is above limit 20,000,000$"),
    "above": (dict(size=3, max_size=2), "size 3 is above max_size 2"),
}


@pytest.mark.parametrize("case", REFUSED)
def test_refused(case):
    options, message = REFUSED[case]
    with pytest.raises(SizingError, match=message) as error:
        Sizing(**options)
    assert isinstance(error.value, ValueError)


def test_numbers_of_any_type_become_floats():
    sizing = Sizing(chord=np.float32(0.5), size=2, max_size=np.int64(7))
    assert (sizing.chord, sizing.size, sizing.max_size) == (0.5, 2.0, 7.0)
    assert all(type(x) is float for x in (sizing.chord, sizing.size, sizing.max_size))


def test_of():
    sizing = Sizing(chord=0.1)
    assert Sizing.of(sizing) is sizing
    assert Sizing.of(None) == Sizing()
    assert Sizing.of(3) == Sizing(size=3.0)
    assert Sizing.of({"chord": 0.1, "growth": 2}) == Sizing(chord=0.1, growth=2.0)
    assert Sizing.of(abs).size is abs
    with pytest.raises(SizingError, match="unknown size option 'chrod'; did you mean 'chord'"):
        Sizing.of({"chrod": 1})
    with pytest.raises(SizingError, match="sizes are a number, a Sizing or a mapping, not str"):
        Sizing.of("0.1")


def test_gradient_is_that_of_touching_circles():
    growth = 1.3
    slope = Sizing(growth=growth).gradient
    h = 1.0
    distance = (h + growth * h) / 2
    assert h + slope * distance == pytest.approx(growth * h)


def test_options_cannot_be_changed():
    sizing = Sizing(chord=0.1)
    with pytest.raises(AttributeError):
        sizing.chord = 0.2
    assert sizing.replaced(chord=0.2).chord == 0.2 and sizing.chord == 0.1


@pytest.mark.parametrize("bad", [0.0, -1.0, math.nan])
def test_a_law_that_gives_no_size_is_told_where(bad):
    points = np.array([[1.0, 2.0, 3.0], [4.0, 5.0, 6.0], [7.0, 8.0, 9.0]])
    law = Sizing(size=lambda points: np.where(points[:, 0] > 3.0, bad, 1.0))
    with pytest.raises(SizingError, match=rf"it gave {bad:g} at \(4, 5, 6\)$"):
        law.law_sizes(points)


def test_orders_of_any_type_become_whole_numbers():
    assert [type(Sizing(order=order).order) for order in (2, 2.0, np.int64(2))] == [int] * 3
    with pytest.raises(SizingError, match="order is True"):
        sizes_of_order(None, True)
