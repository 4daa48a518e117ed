"""Everything the packing kernels work on, in one tuple of flat arrays."""

from typing import NamedTuple

import numpy as np

from surfmesh.kernels.packing.front import Front
from surfmesh.kernels.packing.heap import Heap
from surfmesh.kernels.triangulation.triangulation import Triangulation


class Packing(NamedTuple):
    t: Triangulation
    front: Front
    heap: Heap
    parked: np.ndarray  # (capacity, 2) int32: front edges that wait for their neighbours
    radius: np.ndarray  # (vertices,) float64: got over wanted radius of each circle
    drawn: np.ndarray  # (vertices,) float64: the radius each circle is to have, or (0,) when
    # sizes come from the background
    where: np.ndarray  # (10,) float64: origin x, y; box x0, y0, x1, y1; key metric 11, 12, 22;
    # square of the largest distance from the origin
    count: np.ndarray  # (10,) int64: see the indices below


WANTED, PARKED, STEPS, FITS, TANGENTS, CLOSED, FORCED, MOVES, BRUTE, FORCING = range(10)
