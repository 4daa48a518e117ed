"""Which triangles meet along which edges: unique edges and twins, from the triangles alone.

Half-edge ``3 t + i`` runs from corner ``i`` of triangle ``t`` to corner ``i + 1``:

              c                       triangles[t] = (a, b, c)
             / \\
     3t+2   /   \\  3t+1
           /  t  \\
          a ----- b
             3t

Nothing is assumed of the triangles: edges may bound one, two or more of them, and two
neighbours may run along their common edge in the same direction (a Moebius strip).
"""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray


class Connectivity(NamedTuple):
    """The unique edges of a mesh and who shares them. Half-edges as in the module's docstring."""

    edges: NDArray[np.int32]  # (ne, 2) vertex numbers, the smaller first
    half_edges: NDArray[
        np.int32
    ]  # (ne, 2) the first two that run along each edge, the lower first, or -1
    uses: NDArray[np.int32]  # (ne,) how many triangles use each edge: 1 on a boundary

    @property
    def boundary(self) -> NDArray[np.int32]:
        """Edges of one triangle only, (nb, 2) vertex numbers."""
        return self.edges[self.uses == 1]


def connect(triangles: NDArray[np.int32]) -> Connectivity:
    """Connectivity of ``triangles``, (m, 3) vertex numbers.

    Triangles with a repeated corner give loops (a, a), which are edges like any other here.
    """
    from surfmesh._core.space import edge_table  # late: files are looked at without the core

    return Connectivity(*edge_table(triangles))
