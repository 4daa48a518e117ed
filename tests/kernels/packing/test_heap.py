"""The heap gives back what it was given, in order."""

import heapq

from hypothesis import given, settings
from hypothesis import strategies as st

from surfmesh.kernels.packing.heap import empty_heap, pop, push

# few different numbers: ties of the key, of key and a, of all three
entry = st.tuples(
    st.sampled_from([-1.5, 0.0, 0.5, 2.0, 1e300]), st.integers(0, 3), st.integers(0, 3)
)


@settings(max_examples=200)
@given(st.lists(entry, max_size=40))
def test_sorted(entries):
    heap = empty_heap(len(entries) + 1)
    for key, a, b in entries:
        push(heap, key, a, b)
    assert [pop(heap) for _ in entries] == sorted(entries)
    assert heap.count[0] == 0


@settings(max_examples=200)
@given(st.lists(st.one_of(entry, st.none()), max_size=60))
def test_pushes_and_pops_in_any_order(actions):
    """None pops. The twin is heapq on tuples."""
    heap, twin = empty_heap(len(actions) + 1), []
    for action in actions:
        if action is not None:
            push(heap, *action)
            heapq.heappush(twin, action)
        elif twin:
            assert pop(heap) == heapq.heappop(twin)
    assert heap.count[0] == len(twin)
