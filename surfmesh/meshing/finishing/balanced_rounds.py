"""Meshes whose vertices are balanced: sizes for nearly twice the chord, smaller where need be.

    sizes for 1.9 chord ->  mesh on the surface  ->  vertices balanced  ->  farther than chord?
          ^                                                                       |
          +------------------------- smaller sizes there -------------------------+

Where the surface bends one way, as all convex and hollow faces do, half the deviation is won. On a
saddle triangles lie on both sides from the start, and nearly nothing is.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator, Mapping
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from surfmesh.accuracy.samples import DENSE
from surfmesh.geometry.boxes import diagonal
from surfmesh.geometry.parameter_grid import parameter_grid
from surfmesh.geometry.surface import Surface
from surfmesh.meshing.finishing.balanced_vertices import balanced
from surfmesh.meshing.finishing.kept_volumes import Solid
from surfmesh.meshing.finishing.second_order import put_on_curves
from surfmesh.meshing.finishing.signed_distances import PLACES, signed_distances
from surfmesh.meshing.finishing.turned_edges import turned_edges
from surfmesh.result.surface_mesh import SurfaceMesh
from surfmesh.sizing.options.defaults import with_default_chord
from surfmesh.sizing.options.model_sizing import ModelSizing
from surfmesh.sizing.options.sizing import Sizing
from surfmesh.sizing.rules.size_limits import SizeLimits

WIDER = 1.9
"""Times the chord: what sizes are made for. Twice would leave no room where neighbours differ."""

STALLED = 3
"""After so many rounds that have brought the farthest place no nearer, nor left fewer places that
are too far, no more are made as they were."""

TIGHTER, TIGHTENED, NEARLY = 0.96, 2, 1.1
"""Then all sizes are made for this times as much, so often at most, where the farthest place is
nearer than so many chords: each round had a few new ones that just exceed it. Else, and after that,
the report says what is left."""

KEPT = 0.99
"""Of the chord: what is let pass at the places that are looked at."""

SUSPECT = 0.9
"""Of the chord: from there triangles are looked at as closely as the report does."""

AMID = 1.04
"""Times the distance of a rim in the middle of its chord: with ends that have moved by different
lengths it is a little larger beside it."""

FINER, FINEST, COARSEST = 0.9, 0.5, 0.9
"""Times the size at which the deviation, which falls with its square, would be the chord, or the
angle, which falls with it, what is asked for; bounds of the factor in one round."""

_LOOKED_AT = np.concatenate([np.eye(3), PLACES])


def widened(sizing: Sizing, wider: float = WIDER) -> Sizing:
    """What a mesh is made with whose vertices are balanced afterwards: its volumes are kept then,
    whatever its sizes."""
    chord = None if sizing.chord is None else wider * sizing.chord
    return sizing.replaced(chord=chord, volume=None)


def with_chord_of_surface(surface: Surface, sizing: Sizing) -> Sizing:
    """``sizing`` with the default chord of a surface where nothing else is asked for."""
    points = surface.evaluate(parameter_grid(surface.domain, 33), 0)[0]
    extent = diagonal(points[np.isfinite(points).all(axis=1)])
    return with_default_chord(sizing, extent)


def widened_model(asked: ModelSizing, wider: float = WIDER) -> ModelSizing:
    """``widened`` of all faces, edges and vertices of a model."""

    def every(own: Mapping[int, Sizing]) -> dict[int, Sizing]:
        return {number: widened(sizing, wider) for number, sizing in own.items()}

    return replace(
        asked,
        base=widened(asked.base, wider), stated=widened(asked.stated, wider),
        faces=every(asked.faces), edges=every(asked.edges), vertices=every(asked.vertices),
        entries=tuple(
            entry._replace(sizing=widened(entry.sizing, wider)) for entry in asked.entries
        ),
    )  # fmt: skip


def balanced_in_rounds(
    on_surface: Callable[[float, Mapping[int, SizeLimits]], SurfaceMesh],
    chords: Callable[[SurfaceMesh], NDArray[np.float64]],
    angles: Callable[[SurfaceMesh], NDArray[np.float64]],
    solids: Callable[[SurfaceMesh], list[Solid]],
) -> SurfaceMesh:
    """The mesh of the round whose farthest place is nearest, beside its chord.

    on_surface: a mesh with its vertices on the surface, sized for so many chords and within limits
    of the sizes by face. chords, angles: (f,) that its faces are to keep to, the latter in degrees,
    infinite for none. solids: whose volumes are kept.
    """
    known: dict[int, SizeLimits] = {}
    nearest, fewest, stalled, tightened = math.inf, math.inf, 0, 0
    while stalled < STALLED:
        mesh = on_surface(WIDER * TIGHTER**tightened, known)
        moved = balanced(mesh, chords(mesh), solids(mesh))
        worst = 0.0
        found: dict[int, SizeLimits] = {}
        if moved is not mesh:
            worst, found = _refinements(moved, mesh.points, chords(mesh), angles(mesh))
        left = sum(len(more.sizes) for more in found.values())
        stalled = 0 if worst < nearest or left < fewest else stalled + 1
        if worst < nearest:
            best, nearest = moved, worst
        fewest = min(fewest, left)
        if not found:
            break
        if stalled == STALLED and nearest < NEARLY and tightened < TIGHTENED:
            fewest, stalled, tightened = math.inf, 0, tightened + 1
        known |= {face: more.joined_with(known.get(face)) for face, more in found.items()}
    return best


def _refinements(
    mesh: SurfaceMesh, before: NDArray[np.float64], chords: NDArray[np.float64],
    angles: NDArray[np.float64],
) -> tuple[float, dict[int, SizeLimits]]:  # fmt: skip
    """The largest distance of triangles and rims over the chord of their face, or angle over what
    is asked for, and smaller sizes where that is more than one.

    before: points (n, 3) on the surface.
    """
    assert mesh.sizes is not None and mesh.uv is not None and mesh.sizing is not None  # noqa: S101
    size, chord = mesh.sizes[mesh.triangles].mean(axis=1), chords[mesh.face_ids]
    reached = np.abs(signed_distances(mesh, mesh.points, _LOOKED_AT)).max(axis=1)
    suspects = np.flatnonzero(reached > SUSPECT * chord)
    closely = np.abs(signed_distances(mesh, mesh.points, DENSE, suspects))
    reached[suspects] = closely.max(axis=1, initial=0.0)
    target = size.copy()
    for triangles, distance, length in _at_rims(mesh, before):
        np.maximum.at(reached, triangles, distance)
        far = distance > KEPT * chord[triangles]  # rims may be cut finer than what lies beside them
        np.minimum.at(target, triangles[far], length[far])
    bad = reached > KEPT * chord
    target[bad] *= np.clip(FINER * np.sqrt(chord[bad] / reached[bad]), FINEST, COARSEST)
    turned, turn = turned_edges(mesh, before, angles)
    np.minimum.at(target, turned, size[turned] * np.clip(FINER / turn, FINEST, COARSEST))
    bad[turned] = True
    bad &= target >= (mesh.sizing.min_size or 0.0)
    roots, corners = mesh.metric_root_3d, mesh.uv_triangles
    found: dict[int, SizeLimits] = {}
    for face in np.unique(mesh.face_ids[bad]).tolist():
        own = np.flatnonzero(bad & (mesh.face_ids == face)).repeat(3)
        at = np.arange(len(own)) % 3  # at the corners: amid the triangles they would grow again
        tensors = None
        if roots is not None and corners is not None:
            tensors = roots[corners[own, at]] * (size / target)[own, None]
        found[face] = SizeLimits(
            mesh.points[mesh.triangles[own, at]],
            target[own],
            mesh.sizing.gradient,
            uv=mesh.uv[own, at],
            metric_root_3d=tensors,
        )
    return float(max((reached / chord).max(), turn.max(initial=0.0))), found


def _at_rims(
    mesh: SurfaceMesh, before: NDArray[np.float64]
) -> Iterator[tuple[NDArray[np.int64], NDArray[np.float64], NDArray[np.float64]]]:
    """Triangles (k,) beside curves, how far their sides lie from these, and how long they are: of
    those on one side of the curves, and then on the other."""
    middles = mesh.points[mesh.edges].mean(axis=1)
    chord_middles = middles.copy()
    on = np.flatnonzero(put_on_curves(mesh, middles))
    ends = mesh.edges[on]
    moved = np.linalg.norm(mesh.points - before, axis=1)[ends].max(axis=1)
    sagitta = AMID * np.linalg.norm((middles - chord_middles)[on], axis=1)
    length = np.linalg.norm(mesh.points[ends[:, 1]] - mesh.points[ends[:, 0]], axis=1)
    for half_edges in mesh.connectivity.half_edges[on].T:
        there = half_edges >= 0
        yield half_edges[there] // 3, np.maximum(sagitta, moved)[there], length[there]
