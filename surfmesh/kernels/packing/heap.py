"""A binary heap of directed edges (a, b) with a key, in flat arrays: smallest key first.

Stale entries are not removed; whoever pops one compares it with the front and drops it.
Ties are broken by (a, b), so that the order does not depend on the history of the heap.
"""

from typing import NamedTuple

import numpy as np

from surfmesh.kernels.jit import kernel


class Heap(NamedTuple):
    key: np.ndarray  # (capacity,) float64
    edge: np.ndarray  # (capacity, 2) int32
    count: np.ndarray  # (1,) int64


def empty_heap(capacity: int) -> Heap:
    return Heap(np.empty(capacity), np.empty((capacity, 2), np.int32), np.zeros(1, np.int64))


@kernel
def _before(key, a, b, heap, j):
    if key != heap.key[j]:
        return key < heap.key[j]
    if a != heap.edge[j, 0]:
        return a < heap.edge[j, 0]
    return b < heap.edge[j, 1]


@kernel
def push(heap, key, a, b):
    """Add an entry; the caller keeps ``count < capacity``."""
    i = heap.count[0]
    heap.count[0] = i + 1
    while i > 0:
        parent = (i - 1) >> 1
        if not _before(key, a, b, heap, parent):
            break
        heap.key[i] = heap.key[parent]
        heap.edge[i, 0] = heap.edge[parent, 0]
        heap.edge[i, 1] = heap.edge[parent, 1]
        i = parent
    heap.key[i] = key
    heap.edge[i, 0] = a
    heap.edge[i, 1] = b


@kernel
def pop(heap):
    """Remove and return the smallest (key, a, b); the caller checks that there is one."""
    top_key, top_a, top_b = heap.key[0], heap.edge[0, 0], heap.edge[0, 1]
    n = heap.count[0] - 1
    heap.count[0] = n
    key, a, b = heap.key[n], heap.edge[n, 0], heap.edge[n, 1]
    i = 0
    while True:
        child = 2 * i + 1
        if child >= n:
            break
        if child + 1 < n and _before(
            heap.key[child + 1], heap.edge[child + 1, 0], heap.edge[child + 1, 1], heap, child
        ):
            child += 1
        if not _before(heap.key[child], heap.edge[child, 0], heap.edge[child, 1], heap, n):
            break
        heap.key[i] = heap.key[child]
        heap.edge[i, 0] = heap.edge[child, 0]
        heap.edge[i, 1] = heap.edge[child, 1]
        i = child
    heap.key[i] = key
    heap.edge[i, 0] = a
    heap.edge[i, 1] = b
    return top_key, top_a, top_b
