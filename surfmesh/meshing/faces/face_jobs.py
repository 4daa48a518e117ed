"""Jobs of many faces, made when they are wanted: threads begin with some while the others are made.

nodes of each face -> how much there is to do -> jobs, those of most work first
"""

from collections.abc import Callable, Iterable, Sequence
from typing import Self

from surfmesh.meshing.faces.face_data import FaceJob


class FaceJobs:
    """The jobs of faces 0, 1, ..., some of which may not be made yet."""

    def __init__(
        self, nodes: Sequence[int], make: Callable[[list[int]], Sequence[FaceJob]]
    ) -> None:
        """nodes: how many the boundary of each face has; make: the jobs of some faces."""
        self.nodes = nodes
        self._make = make
        self._made: dict[int, FaceJob] = {}

    @classmethod
    def of(cls, jobs: Sequence[FaceJob]) -> Self:
        """Of jobs that are there."""
        return cls([job.nodes for job in jobs], lambda numbers: [jobs[k] for k in numbers])

    def __len__(self) -> int:
        return len(self.nodes)

    def __getitem__(self, number: int) -> FaceJob:
        """One that is made."""
        return self._made[number]

    def make(self, numbers: Iterable[int]) -> None:
        """Make those of some faces together."""
        wanted = [number for number in numbers if number not in self._made]
        if wanted:
            self._made.update(zip(wanted, self._make(wanted)))
