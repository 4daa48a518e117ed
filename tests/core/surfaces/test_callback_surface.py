"""Surfaces that are the caller's own: called for a block, checked, their exceptions kept."""

import gc
import threading
import weakref

import numpy as np
import pytest

from surfmesh._core.surfaces import CallbackSurface
from surfmesh.geometry.core_surface import as_core_surface

UV = np.random.default_rng(0).random((7, 2))
COUNT = {0: 1, 1: 3, 2: 6}


class Saddle:
    name, domain, loops = "saddle", ((-1.0, 2.0), (0.0, 3.0)), ()

    def evaluate(self, uv, order=0):
        u, v = uv.T
        zero, one = np.zeros_like(u), np.ones_like(u)
        columns = [
            (u, v, u * v),
            (one, zero, v),
            (zero, one, u),
            (zero, zero, zero),
            (zero, zero, one),
            (zero, zero, zero),
        ]
        return tuple(np.stack(c, axis=1) for c in columns[: COUNT[order]])

    def derivative_bounds(self, lo, hi):
        lower, upper = np.full((len(lo), 5, 3), -np.inf), np.full((len(lo), 5, 3), np.inf)
        lower[:, 0, 2], upper[:, 0, 2] = lo[:, 1], hi[:, 1]
        return lower, upper


class Answering(Saddle):
    """A surface that returns, or raises, what it is given."""

    def __init__(self, answer):
        self.answer = answer

    def evaluate(self, uv, order=0):
        if isinstance(self.answer, Exception):
            raise self.answer
        return self.answer

    def derivative_bounds(self, lo, hi):
        return self.evaluate(lo)


@pytest.mark.parametrize("order", [0, 1, 2])
def test_values_are_those_of_the_object(order):
    core = as_core_surface(Saddle())
    assert isinstance(core, CallbackSurface)
    assert core.domain == Saddle.domain
    values = core.evaluate(UV, order)
    assert values.shape == (COUNT[order], 7, 3)
    assert np.array_equal(values, np.array(Saddle().evaluate(UV, order)))


def test_bounds_are_those_of_the_object():
    lower, upper = as_core_surface(Saddle()).derivative_bounds(UV, UV + 1.0)
    wanted = Saddle().derivative_bounds(UV, UV + 1.0)
    assert np.array_equal(lower, wanted[0])
    assert np.array_equal(upper, wanted[1])
    assert as_core_surface(Answering(None)).derivative_bounds(UV, UV) is None


def test_a_surface_of_the_core_is_taken_as_it_is():
    class Thin(Saddle):
        core = as_core_surface(Saddle())

    assert as_core_surface(Thin()) is Thin.core


@pytest.mark.parametrize(
    "answer, message",
    [
        ((), "returned 0 arrays where 1 were asked for"),
        ((np.zeros((6, 3)),), r"array of numbers of the shape \(7, 3\)"),
        ((np.zeros(21),), r"array of numbers of the shape \(7, 3\)"),
        ((np.full((7, 3), "x"),), "array of numbers"),
        (([1.0, 2.0],), "array of numbers"),
    ],
)
def test_what_is_no_answer_is_refused(answer, message):
    with pytest.raises(ValueError, match=message):
        as_core_surface(Answering(answer)).evaluate(UV, 0)


def test_arrays_of_other_numbers_are_converted():
    whole = np.arange(21, dtype=np.int32).reshape(7, 3)
    assert np.array_equal(as_core_surface(Answering((whole,))).evaluate(UV)[0], whole)
    turned = np.asfortranarray(np.random.default_rng(1).random((7, 3)))
    assert np.array_equal(as_core_surface(Answering((turned,))).evaluate(UV)[0], turned)


def test_an_exception_comes_back_as_it_was():
    raised = KeyError("mine")
    core = as_core_surface(Answering(raised))
    for call in (lambda: core.evaluate(UV), lambda: core.derivative_bounds(UV, UV)):
        with pytest.raises(KeyError) as caught:
            call()
        assert caught.value is raised


def test_threads_may_call_at_the_same_time():
    core = as_core_surface(Saddle())
    uv = np.random.default_rng(2).random((1000, 2))
    wanted, found = core.evaluate(uv, 2), [None] * 4

    def work(k):
        found[k] = all(np.array_equal(core.evaluate(uv, 2), wanted) for _ in range(20))

    threads = [threading.Thread(target=work, args=(k,)) for k in range(4)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    assert all(found)


def test_wrong_arguments_are_refused():
    core = as_core_surface(Saddle())
    with pytest.raises(ValueError, match="order"):
        core.evaluate(UV, 4)
    with pytest.raises(TypeError):
        core.evaluate(UV[:, :1])
    with pytest.raises(ValueError, match="rows"):
        core.derivative_bounds(UV, UV[:3])
    with pytest.raises(AttributeError):
        CallbackSurface(3)


def test_a_cycle_of_surface_and_core_is_collected():
    surface = Saddle()
    surface.kept = as_core_surface(surface)
    seen = weakref.ref(surface)
    del surface
    gc.collect()
    assert seen() is None
