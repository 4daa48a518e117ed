"""The triangles of many faces, by a close look at some of them.

    faces -> classes of alike faces -> one face of each class: its size field, its strip
                                    -> of many classes a sample; the others in proportion to
                                       what their boundary nodes and their area say

A bolt circle has one class of holes. Where there are many classes, one is chosen as often as it
holds a quantile of all triangles; planes and curved faces are two populations.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np

from surfmesh._core.faces import loop_figures
from surfmesh.meshing.estimate.estimation import combined
from surfmesh.meshing.faces.face_data import FaceJob
from surfmesh.sizing.field.metric_area import TRIANGLES

CLASSES = 32
"""Of each population all are looked at closely up to so many, so many of more than that."""

DIGITS = 6
"""To which alike faces agree in lengths, areas and sizes."""


def counts_of_faces(
    jobs: list[FaceJob], areas: np.ndarray, count: Callable[[list[FaceJob]], np.ndarray]
) -> np.ndarray:
    """Triangles (f,) on each face. areas: (f,) of the faces; count: looks closely at some."""
    first, class_of = _classes(jobs, areas)
    rough = np.array([_rough(jobs[face], areas[face]) for face in first], float)
    members = np.bincount(class_of, minlength=len(first))
    plane = np.array([jobs[face].surface.kind == "plane" for face in first], bool)
    samples = [
        (of, *_sample(of, (rough * members)[of])) for of in map(np.flatnonzero, (plane, ~plane))
    ]
    close = np.concatenate([chosen for _, chosen, _ in samples])
    counts = np.zeros(len(first))
    counts[close] = count([jobs[first[number]] for number in close.tolist()])
    for of, chosen, times in samples:
        if len(of) > len(chosen):
            others = np.setdiff1d(of, chosen)
            factor = np.average(counts[chosen] / rough[chosen], weights=times)
            counts[others] = factor * rough[others]
    return counts[class_of]


def _sample(of: np.ndarray, weights: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Which of some classes are looked at closely, and how often each was chosen."""
    if len(of) <= CLASSES:
        return of, np.ones(len(of))
    sums = np.cumsum(weights)
    at = (np.arange(CLASSES) + 0.5) / CLASSES * sums[-1]
    return np.unique(of[np.searchsorted(sums, at)], return_counts=True)


def _classes(jobs: list[FaceJob], areas: np.ndarray) -> tuple[list[int], np.ndarray]:
    """The first face of each class of alike ones, and the class (f,) of each face."""
    known: dict[Any, int] = {}
    first: list[int] = []
    class_of = np.empty(len(jobs), int)
    loops = _loops_in_figures(jobs)
    for number, (job, area) in enumerate(zip(jobs, _rounded(areas).tolist())):
        key = _likeness(job, area, loops[number]) or number
        if key not in known:
            known[key] = len(first)
            first.append(number)
        class_of[number] = known[key]
    return first, class_of


def _likeness(job: FaceJob, area: float, loops: bytes) -> Any:
    """What alike faces have in common; None where the place of a face counts too."""
    if job.limits is not None or job.sizing.has_law or job.sizing.sources:
        return None
    return job.surface.kind, job.sizing, job.narrow is not None, area, loops


def _loops_in_figures(jobs: list[FaceJob]) -> list[bytes]:
    """Of each job, of its loops in one order: how many nodes, how long, and the sum of the sizes
    there, rounded, as bytes that are the same where these are."""
    if not jobs:
        return []
    figures, first = loop_figures([job.boundary for job in jobs])
    rows = np.column_stack([figures[:, 0], _rounded(figures[:, 1]), _rounded(figures[:, 2])])
    order = np.lexsort((*rows.T[::-1], np.repeat(np.arange(len(jobs)), np.diff(first))))
    return [own.tobytes() for own in np.split(rows[order], first[1:-1])]


def _rounded(values: np.ndarray) -> np.ndarray:
    """To ``DIGITS`` digits (n,)."""
    size = np.where(values > 0.0, values, 1.0)
    scale = 10.0 ** (DIGITS - 1 - np.floor(np.log10(size)))
    return np.where(values > 0.0, np.rint(size * scale) / scale, values)


def _rough(job: FaceJob, area: float) -> float:
    """Triangles, if the sizes of its boundary hold all over it."""
    sizes, loops = job.boundary.sizes, len(job.boundary.loop_end)
    real = sizes[np.isfinite(sizes)]
    nodes = len(sizes) - len(job.boundary.piece_end)
    inside = TRIANGLES * area / float(real.mean()) ** 2 if len(real) else 0.0
    return max(combined(inside, nodes, loops), 1.0)
