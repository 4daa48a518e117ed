"""The triangles of many faces, by a close look at some of them.

    faces -> classes of alike faces -> one face of each class: its size field, its strip
                                    -> of many classes a sample; the others in proportion to
                                       what their boundary nodes and their area say

A bolt circle has one class of holes. Where there are many classes, one is chosen as often as it
holds a quantile of all triangles; planes and curved faces are two populations. Classes that hold
few triangles all together are not looked at: what their nodes and areas say is enough.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import Any, NamedTuple, Self

import numpy as np

from surfmesh._core.faces import alike_faces, fewest_triangles
from surfmesh.meshing.estimate.estimation import combined
from surfmesh.meshing.faces.face_data import FaceJob
from surfmesh.sizing.field.metric_area import TRIANGLES

CLASSES = 32
"""Of each population all are looked at closely up to so many, so many of more than that."""

FEW = 0.01
"""Share of the triangles that are told from nodes and areas alone, at most: faces of classes that
could not hold more whatever their sizes inside."""


def fewest_of(jobs: Sequence[FaceJob]) -> np.ndarray:
    """Triangles (f,) within the loops of faces when no node lies inside, by Euler's formula."""
    return np.asarray(fewest_triangles([job.boundary for job in jobs]))


class Alike(NamedTuple):
    """Faces in classes of alike ones."""

    fewest: np.ndarray
    """(f,) as ``fewest_of``."""
    size: np.ndarray
    """(f,) mean of the sizes at the nodes; infinite where there are none."""
    first: np.ndarray
    """(k,) the first face of each class."""
    of: np.ndarray
    """(f,) the class of each face."""

    @classmethod
    def among(cls, jobs: list[FaceJob], areas: np.ndarray) -> Self:
        """areas: (f,) of the faces."""
        return cls(*alike_faces([job.boundary for job in jobs], areas, _sorts(jobs)))

    @property
    def leader(self) -> np.ndarray:
        """(f,) the first face that is like each."""
        return self.first[self.of]


def counts_of_faces(
    jobs: list[FaceJob], areas: np.ndarray, most: np.ndarray, alike: Alike,
    count: Callable[[list[int]], np.ndarray],
) -> np.ndarray:  # fmt: skip
    """Triangles (f,) on each face. areas: (f,) of the faces; most: (f,) that fit on them by their
    area, infinite where nothing is known; count: of some by their numbers, after a closer look."""
    first = alike.first
    inside = TRIANGLES * areas[first] / alike.size[first] ** 2
    rough = np.maximum(combined(inside, alike.fewest[first]), 1.0)
    members = np.bincount(alike.of, minlength=len(first))
    weight = rough * members
    leaders = [jobs[face] for face in first.tolist()]
    plane = np.array([job.surface.kind == "plane" for job in leaders], bool)
    stretched = np.array([job.sizing.is_anisotropic for job in leaders], bool)
    largest = np.where(stretched, np.inf, np.maximum(most[first], rough))  # edges are cut again
    few = _are_few(largest * members, weight.sum())
    samples = [(of, *_sample(of[~few[of]], weight)) for of in map(np.flatnonzero, (plane, ~plane))]
    close = np.concatenate([chosen for _, chosen, _ in samples])
    counts = rough.copy()
    counts[close] = count(first[close].tolist())
    is_close = np.zeros(len(first), bool)
    is_close[close] = True
    for of, chosen, times in samples:
        if 0 < len(chosen) < len(of):
            ratio = (counts[chosen] / rough[chosen] * times).sum() / times.sum()
            counts[of[~is_close[of]]] *= ratio
    return counts[alike.of]


def _are_few(most: np.ndarray, total: float) -> np.ndarray:
    """Which classes of at most so many triangles (k,) hold few of all of them together?"""
    order = most.argsort(kind="stable")
    found = np.empty(len(most), bool)
    found[order] = most[order].cumsum() <= FEW * total
    return found


def _sample(of: np.ndarray, weight: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Which of some classes are looked at closely, and how often each was chosen; weight: of all
    classes."""
    if len(of) <= CLASSES:
        return of, np.ones(len(of))
    sums = weight[of].cumsum()
    at = (np.arange(CLASSES) + 0.5) / CLASSES * sums[-1]
    return np.unique(of[np.searchsorted(sums, at)], return_counts=True)


def _sorts(jobs: list[FaceJob]) -> np.ndarray:
    """(f,) int64, the same of faces that are alike but for their loops and areas; those are alike
    to none whose place counts too."""
    sizings = {id(job.sizing): job.sizing for job in jobs}
    kept = {key: None if own.has_law or own.sources else own for key, own in sizings.items()}
    known: dict[Any, int] = {}
    number_of = {key: own and known.setdefault(own, len(known)) for key, own in kept.items()}
    sorts: dict[Any, int] = {}

    def sort(number: int, job: FaceJob) -> int:
        sizing = number_of[id(job.sizing)]
        is_alone = job.limits is not None or sizing is None
        own = number if is_alone else (job.surface.kind, sizing, job.narrow is not None)
        return sorts.setdefault(own, len(sorts))

    return np.array([sort(number, job) for number, job in enumerate(jobs)], np.int64)
