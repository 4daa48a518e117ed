"""The mesh of a face that the core keeps in rows with those of other faces.

Most faces of a model are joined as they are: nobody looks at their arrays one by one, so they are
cut out of the rows where they are asked for.
"""

from functools import cached_property

import numpy as np

from surfmesh._core.faces import FaceBoundary, FaceJoiner, FaceRows
from surfmesh.meshing.faces.face_data import FaceMesh


class FaceInRows(FaceMesh):
    """A face that is done, has triangles and asks for nothing."""

    _rows: FaceRows
    _place: int
    _count: int

    def __init__(self, rows: FaceRows, place: int, count: int) -> None:
        """place: among the faces of the rows; count: its triangles."""
        self.__dict__.update(_rows=rows, _place=place, _count=count)

    @property
    def count(self) -> int:
        return self._count

    @property
    def is_empty(self) -> bool:
        return False

    def whole(self) -> FaceMesh:
        """By itself, so that it can be sent and changed."""
        return FaceMesh(
            self.points, self.slots, self.triangles, self.uv_points, self.uv_triangles, self.sizes
        )

    def add_to(
        self, joiner: FaceJoiner, boundary: FaceBoundary, face: int, is_turned: bool
    ) -> None:  # fmt: skip
        joiner.add_row(self._rows, self._place, boundary, face, is_turned)

    def __reduce__(self) -> tuple:
        return FaceMesh.whole, (self.whole(),)

    @cached_property
    def points(self) -> np.ndarray:
        return self._between(self._rows.points, self._rows.point_end)

    @cached_property
    def slots(self) -> np.ndarray:
        return self._between(self._rows.slots, self._rows.point_end)

    @cached_property
    def sizes(self) -> np.ndarray:
        return self._between(self._rows.sizes, self._rows.point_end)

    @cached_property
    def triangles(self) -> np.ndarray:
        return self._between(self._rows.triangles, self._rows.triangle_end)

    @cached_property
    def uv_triangles(self) -> np.ndarray:
        return self._between(self._rows.uv_triangles, self._rows.triangle_end)

    @cached_property
    def uv_points(self) -> np.ndarray:
        return self._between(self._rows.uv, self._rows.corner_end)

    def _between(self, all_of_them: np.ndarray, ends: np.ndarray) -> np.ndarray:
        first = ends[self._place - 1] if self._place else 0
        return all_of_them[first : ends[self._place]]
