"""The generation front (2.1): one closed loop of circles, a doubly linked list.

The loop is the border of the region DONE of a triangulation of the whole plane. To advance is
to hand triangles over from TODO to DONE:

    insert: the new circle p on the edge a -> b          close: the corner at b is filled
                                                         (c = next[b])
            p                                                 c
           / \\                                               / \\
          /   \\     a -> p -> b                    a -----> /   \\      a -> c, b leaves
         a --- b                                    \\ new  /     |
          done                                        \\   b      |
"""

from typing import NamedTuple

import numpy as np

from surfmesh.kernels import NIL
from surfmesh.kernels.jit import kernel

TODO = 0
DONE = 1


class Front(NamedTuple):
    next: np.ndarray  # (vertices,) int32, NIL off the front
    prev: np.ndarray  # (vertices,) int32, NIL off the front
    edge: np.ndarray  # (vertices,) int32: done half-edge from v to next[v]


def empty_front(vertices: int) -> Front:
    return Front(*(np.full(vertices, NIL, np.int32) for _ in range(3)))


@kernel
def link(front, a, b, e):
    """Make a -> b an edge of the front, with e its half-edge in a done triangle."""
    front.next[a] = b
    front.prev[b] = a
    front.edge[a] = e


@kernel
def unlink(front, b):
    """b has left the front."""
    front.next[b] = NIL
    front.prev[b] = NIL
    front.edge[b] = NIL
