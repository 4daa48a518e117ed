"""The chord at which closed solids keep their volume, where ``Sizing(volume=)`` asks for it.

A unit triangle on the quadric z = (k1 x^2 + k2 y^2) / 2, with edges h1 and h2 along its
directions, lies (k1 h1^2 + k2 h2^2) / 16 from it in the mean: linear interpolation of x^2 on an
equilateral triangle of side h errs by h^2 / 8 in the mean. With sizes by a chord c this is a known
fraction of c. So

    volume lost (c)  =  sum over the solid's curved faces of   integral of that part of c  dA

less what concave places gain, and the largest c that keeps it within what was asked for is a chord
of the faces of that solid, beside whatever else they are asked for. It is a rule of sizes, no
promise of the distance.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace
from typing import NamedTuple

import numpy as np

from surfmesh.cad.model.cad_model import CadFace, CadModel, CadSolid
from surfmesh.cad.model.centres import inner_samples
from surfmesh.cad.selection.selection import Selection
from surfmesh.errors import SizingError
from surfmesh.geometry.differential.fundamental_forms import curvatures, forms_from_derivatives
from surfmesh.sizing.options.model_sizing import Entry, ModelSizing
from surfmesh.sizing.options.sizing import Sizing
from surfmesh.sizing.rules.curvature_size import chord_size, principal_chord_sizes
from surfmesh.sizing.rules.size_rules import SizeRules

SAMPLES = 9
"""Points each way of a grid on a face."""

AIM = 0.9
"""Fraction of the error asked for that is used: triangles differ from unit ones."""

CERTAIN = 0.3
"""Losses and gains are taken to cancel but for this fraction of the larger."""

HALVINGS = 60
"""Steps of the bisection for the chord, from the diagonal down."""

FAINT = 1e-9
"""Chords relative to the radius of curvature at which sizes are proportional to their root."""


def with_volume_rule(
    model: CadModel, wanted: ModelSizing, aims: Mapping[int, float] | None = None
) -> ModelSizing:
    """The same sizes with the chords that keep the volumes of closed solids.

    aims: for solids that the rule was too coarse for, the error to aim at instead of AIM of
    that asked for. Raises ``SizingError`` when the model has no closed solid.
    """
    asked = wanted.base.volume
    if asked is None:
        return wanted
    closed = [k for k, solid in enumerate(model.solids) if solid.closed and solid.volume > 0.0]
    if not closed:
        raise SizingError(
            f"volume {asked:g} is asked for, but {model.name or model.source!r} has no closed "
            "solid whose volume could be kept; ask for a chord"
        )
    sizings, entries = dict(wanted.faces), list(wanted.entries)
    for number in closed:
        solid = model.solids[number]
        faces = curved_faces(model, solid)
        aim = (aims or {}).get(number, AIM * asked)
        chord = volume_chord(model, solid, faces, wanted, aim)
        if chord is None:
            continue
        key = f"volume {asked:g} of solid {number}"
        entries.append(Entry(key, Sizing(chord=chord), Selection(faces=tuple(faces)), True))
        for face in faces:
            own = sizings.get(face, wanted.base)
            sizings[face] = own.replaced(chord=min(chord, own.chord or np.inf))
    return replace(wanted, faces=sizings, entries=tuple(entries), promised=wanted)


def curved_faces(model: CadModel, solid: CadSolid) -> list[int]:
    """Numbers of the faces of a solid that are no planes, each once."""
    faces = {face for shell in solid.shells for face, _ in shell}
    return sorted(face for face in faces if model.faces[face].kind != "plane")


def volume_chord(
    model: CadModel, solid: CadSolid, faces: list[int], wanted: ModelSizing, error: float
) -> float | None:
    """The chord for ``faces`` that keeps the volume to a relative ``error``; None where their
    sizes do anyway."""
    against = {face: flag for shell in solid.shells for face, flag in shell}
    parts = [
        _lost(model.faces[face], wanted.of_face(face), model.diagonal, against[face])
        for face in faces
    ]
    if not parts:
        return None
    lost = _Lost(*(np.concatenate(columns) for columns in zip(*parts)))
    allowed = error * solid.volume
    if lost.within(np.inf) <= allowed:
        return None
    low, high = 0.0, model.diagonal
    for _ in range(HALVINGS):
        middle = 0.5 * (low + high)
        low, high = (middle, high) if lost.within(middle) <= allowed else (low, middle)
    return low or None


class _Lost(NamedTuple):
    """At samples of curved faces, (n,) each."""

    convex: np.ndarray
    """Sign: +1 where the mesh lies inside of the solid, -1 outside."""
    area: np.ndarray
    """That a sample stands for."""
    of_chord: np.ndarray
    """Mean distance between mesh and surface over the chord, where that decides the size."""
    at_most: np.ndarray
    """Mean distance that the other sizes allow, model units."""

    def within(self, chord: float) -> float:
        """Volume lost less volume gained by sizes within ``chord``, or CERTAIN of the larger."""
        with np.errstate(invalid="ignore"):
            gap = np.fmin(self.of_chord * chord, self.at_most)
        volume = self.area * np.nan_to_num(gap, posinf=0.0)
        lost, gained = volume[self.convex > 0].sum(), volume[self.convex < 0].sum()
        return float(max(abs(lost - gained), CERTAIN * max(lost, gained)))


def _lost(face: CadFace, sizing: Sizing, diagonal: float, against: bool) -> _Lost:
    """against: the solid lies on the side of the face's normal."""
    uv = inner_samples(face, SAMPLES)
    if not len(uv):
        return _Lost(*np.empty((4, 0)))
    forms = forms_from_derivatives(*face.surface.evaluate(uv, 2)[1:])
    k = curvatures(forms)
    known = ~forms.degenerate & np.isfinite(k.k1) & np.isfinite(k.k2)
    k1, k2 = k.k1[known], k.k2[known]
    area = np.sqrt(np.maximum(forms.E * forms.G - forms.F**2, 0.0))[known]
    area *= face.area / max(area.sum(), np.finfo(float).tiny)
    rules = SizeRules.of(sizing, diagonal)
    sizes = np.full((len(k1), 2), rules.clamp[1])
    if rules.follows_curvature and rules.sizing.is_anisotropic:
        sizes = rules.principal(k1, k2)
    elif rules.follows_curvature:
        sizes[:] = rules.from_curvature(k1, k2)[:, None]
    if isinstance(sizing.size, float):
        np.minimum(sizes, sizing.size, out=sizes)
    gap = _mean_gap(k1, k2, *sizes.T)
    # at a chord of FAINT times the radius; with lengths in radii, as sizes go with them
    curvature = np.maximum(np.maximum(np.abs(k1), np.abs(k2)), np.finfo(float).tiny)
    first, second = k1 / curvature, k2 / curvature
    if sizing.anisotropy > 1.0:
        unit = principal_chord_sizes(first, second, FAINT, sizing.anisotropy)
    else:
        unit = (chord_size(first, second, FAINT),) * 2
    of_chord = _mean_gap(first, second, *unit) / FAINT
    # a surface that bends away from its normal, as a sphere does, has k1 + k2 < 0
    outward = -1.0 if against != face.reversed else 1.0
    return _Lost(np.where(outward * gap < 0.0, 1.0, -1.0), area, np.abs(of_chord), np.abs(gap))


def _mean_gap(k1: np.ndarray, k2: np.ndarray, h1: np.ndarray, h2: np.ndarray) -> np.ndarray:
    """Signed mean distance (n,) of unit triangles from the quadric; a flat direction adds none."""
    with np.errstate(invalid="ignore"):
        parts = np.nan_to_num(k1 * h1**2) + np.nan_to_num(k2 * h2**2)
    return parts / 16.0
