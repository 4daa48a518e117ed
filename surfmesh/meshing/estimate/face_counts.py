"""The triangles of many faces, by a close look at some of them.

    faces -> classes of alike faces -> one face of each class: its size field, its strip
                                    -> of many classes a sample; the others in proportion to
                                       what their boundary nodes and their area say

A bolt circle has one class of holes. Where there are many classes, one is chosen as often as it
holds a quantile of all triangles; planes and curved faces are two populations. Classes that hold
few triangles all together are not looked at: what their nodes and areas say is enough.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from itertools import pairwise
from typing import Any, NamedTuple, Self

import numpy as np

from surfmesh._core.faces import loop_figures
from surfmesh.meshing.estimate.estimation import combined
from surfmesh.meshing.faces.face_data import FaceJob
from surfmesh.sizing.field.metric_area import TRIANGLES
from surfmesh.sizing.options.sizing import Sizing

CLASSES = 32
"""Of each population all are looked at closely up to so many, so many of more than that."""

FEW = 0.01
"""Share of the triangles that are told from nodes and areas alone, at most: faces of classes that
could not hold more whatever their sizes inside."""

DIGITS = 6
"""To which alike faces agree in lengths, areas and sizes."""


class Outlines(NamedTuple):
    """What the loops of faces say of them."""

    segments: np.ndarray
    """(f,) of all loops of each face."""
    loops: np.ndarray
    """(f,) how many it has."""
    size: np.ndarray
    """(f,) mean of the sizes at the nodes; infinite where there are none."""
    alike: tuple[bytes, ...]
    """Of the loops of each face in one order: how many segments, how long, and the sum of the
    sizes there, rounded, as bytes that are the same where these are."""

    @classmethod
    def of(cls, jobs: Sequence[FaceJob]) -> Self:
        if not jobs:
            return cls(np.empty(0), np.empty(0, int), np.empty(0), ())
        figures, first = loop_figures([job.boundary for job in jobs])
        loops = np.diff(first)
        face = np.repeat(np.arange(len(jobs)), loops)
        segments, _, sizes, sized = (
            np.bincount(face, weights=column, minlength=len(jobs)) for column in figures.T
        )
        rows = np.column_stack([figures[:, 0], _rounded(figures[:, 1:3])])
        rows = rows[np.lexsort((*rows.T[::-1], face))]
        data, width = rows.tobytes(), rows.itemsize * rows.shape[1]
        alike = tuple(data[a:b] for a, b in pairwise((width * first).tolist()))
        size = np.full(len(jobs), np.inf)
        np.divide(sizes, sized, out=size, where=sized > 0.0)
        return cls(segments, loops, size, alike)

    @property
    def fewest(self) -> np.ndarray:
        """Triangles (f,) within the loops when no node lies inside, by Euler's formula."""
        return self.segments + 2.0 * self.loops - 4.0


def fewest_of(jobs: Sequence[FaceJob]) -> np.ndarray:
    """``Outlines.fewest`` alone."""
    if not jobs:
        return np.empty(0)
    figures, first = loop_figures([job.boundary for job in jobs])
    loops = np.diff(first)
    face = np.repeat(np.arange(len(jobs)), loops)
    return np.bincount(face, figures[:, 0], len(jobs)) + 2.0 * loops - 4.0


class Alike(NamedTuple):
    """Faces in classes of alike ones."""

    outlines: Outlines
    """Of all faces."""
    first: np.ndarray
    """(k,) the first face of each class."""
    of: np.ndarray
    """(f,) the class of each face."""

    @classmethod
    def among(cls, jobs: list[FaceJob], areas: np.ndarray) -> Self:
        """areas: (f,) of the faces."""
        outlines, known = Outlines.of(jobs), dict[Any, int]()
        keys = _likenesses(jobs, _rounded(areas), outlines)
        of = np.array([known.setdefault(key, len(known)) for key in keys], int)
        return cls(outlines, np.unique(of, return_index=True)[1], of)

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
    outlines, first = alike.outlines, alike.first
    inside = TRIANGLES * areas[first] / outlines.size[first] ** 2
    rough = np.maximum(combined(inside, outlines.fewest[first]), 1.0)
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
    order = np.argsort(most, kind="stable")
    found = np.empty(len(most), bool)
    found[order] = np.cumsum(most[order]) <= FEW * total
    return found


def _sample(of: np.ndarray, weight: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Which of some classes are looked at closely, and how often each was chosen; weight: of all
    classes."""
    if len(of) <= CLASSES:
        return of, np.ones(len(of))
    sums = np.cumsum(weight[of])
    at = (np.arange(CLASSES) + 0.5) / CLASSES * sums[-1]
    return np.unique(of[np.searchsorted(sums, at)], return_counts=True)


def _likenesses(jobs: list[FaceJob], areas: np.ndarray, outlines: Outlines) -> Iterator[Any]:
    """What alike faces have in common; the number of a face where its place counts too."""
    known: dict[Sizing, int] = {}
    sizings = {id(job.sizing): job.sizing for job in jobs}
    of_sizing = {
        key: None if own.has_law or own.sources else known.setdefault(own, len(known))
        for key, own in sizings.items()
    }
    for number, (job, area, loops) in enumerate(zip(jobs, areas.tolist(), outlines.alike)):
        sizing = of_sizing[id(job.sizing)]
        if job.limits is not None or sizing is None:
            yield number
        else:
            yield job.surface.kind, sizing, job.narrow is not None, area, loops


def _rounded(values: np.ndarray) -> np.ndarray:
    """To ``DIGITS`` digits, in the shape that they have."""
    size = np.where(values > 0.0, values, 1.0)
    scale = 10.0 ** (DIGITS - 1 - np.floor(np.log10(size)))
    return np.where(values > 0.0, np.rint(size * scale) / scale, values)
