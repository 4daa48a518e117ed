"""The heap gives back what it was given, in order."""

import heapq

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from surfmesh._core.packing import EdgeHeap

# few different numbers: ties of the key, of key and a, of all three
entry = st.tuples(
    st.sampled_from([-1.5, 0.0, 0.5, 2.0, 1e300]), st.integers(0, 3), st.integers(0, 3)
)


@settings(max_examples=200)
@given(st.lists(entry, max_size=40))
def test_sorted(entries):
    heap = EdgeHeap()
    for key, a, b in entries:
        heap.push(key, a, b)
    assert [heap.pop() for _ in entries] == sorted(entries)
    assert len(heap) == 0


@settings(max_examples=200)
@given(st.lists(st.one_of(entry, st.none()), max_size=60))
def test_pushes_and_pops_in_any_order(actions):
    """None pops. The twin is heapq on tuples."""
    heap, twin = EdgeHeap(), []
    for action in actions:
        if action is not None:
            heap.push(*action)
            heapq.heappush(twin, action)
        elif twin:
            assert heap.pop() == heapq.heappop(twin)
    assert len(heap) == len(twin)


def test_nothing_to_pop():
    with pytest.raises(IndexError):
        EdgeHeap().pop()
