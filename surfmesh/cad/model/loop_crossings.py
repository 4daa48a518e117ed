"""Do loops cross where they come near to each other, and how deep?

     |  one                 branches of the one lie on both sides of the other
_____|_____ other
     |  ^
     |  | lobe: how far it goes on the other side
"""

from __future__ import annotations

import numpy as np

from surfmesh.cad.model.loop_curves import LoopCurves
from surfmesh.geometry.planar.curve_circles import leaving
from surfmesh.geometry.planar.curve_contacts import Contact, closest

DEEP = 2.0
"""Times the tolerance of the edges: p-curves that cross by more cannot be taken apart."""

LOBE_SAMPLES = 9
"""Points of a lobe."""

DOUBLINGS, MOST_RADII = 2.0 ** np.arange(8), 40
"""Circles around a contact that branches are looked at on together, and in all."""

NEARLY = 0.1
"""Of what is near: so near is it known where a branch leaves a circle."""


def crossing_depth(loops: LoopCurves, contact: Contact) -> float:
    """How deep the curves cross there, in model units; 0 where they do not, or hardly."""
    if not _is_crossing(loops, contact):
        return 0.0
    one, other = contact.curves
    deep = DEEP * max(loops.tolerance[one], loops.tolerance[other], loops.near.max())
    depth = min(
        _lobe(loops, contact, place, forward) for place in (0, 1) for forward in (False, True)
    )
    return depth if depth > deep else 0.0


def _is_crossing(loops: LoopCurves, contact: Contact) -> bool:
    """Do the two branches of the one curve lie on both sides of those of the other?"""
    one, other = contact.curves
    first, second = (
        loops.curves[curve].evaluate(np.mean(fraction, keepdims=True))[0]
        for curve, fraction in zip(contact.curves, contact.fractions)
    )
    centre = 0.5 * (first + second)
    near = max(loops.near[one], loops.near[other])
    radius = max(16.0 * near, 4.0 * loops.tolerance[one], 4.0 * loops.tolerance[other])
    for _ in range(MOST_RADII // len(DOUBLINGS)):
        radii = radius * DOUBLINGS
        branches = np.array([
            _branch(loops, contact, place, forward, centre, radii)
            for place in (0, 1) for forward in (False, True)
        ])  # fmt: skip
        for ways in (branches - centre).transpose(1, 0, 2):
            if np.isnan(ways).any():
                return False
            apart = np.linalg.norm(ways[:2, None] - ways[None, 2:], axis=2).min()
            if apart > 8.0 * near:
                angle = np.arctan2(ways[:, 1], ways[:, 0])
                turn = np.mod(angle - angle[0], 2.0 * np.pi)
                return bool((turn[2] < turn[1]) != (turn[3] < turn[1]))
        radius = 2.0 * float(radii[-1])
    return False


def _branch(
    loops: LoopCurves, contact: Contact, place: int, forward: bool,
    centre: np.ndarray, radii: np.ndarray,
) -> np.ndarray:  # fmt: skip
    """Where a branch of a loop, on from the contact, is first so far (r,) from it: (r, 2), nan
    where it is nowhere."""
    curve, fraction = contact.curves[place], contact.fractions[place][int(forward)]
    found = np.full((len(radii), 2), np.nan)
    for _ in range(len(loops.of_face.loops[loops.loop_of[curve]]) + 1):
        left = np.isnan(found[:, 0])
        if not left.any():
            break
        end = 1.0 if forward else 0.0
        enough = NEARLY * loops.near[curve]
        found[left] = leaving(loops.curves[curve], fraction, end, centre, radii[left], enough)
        curve, fraction = loops.following(curve, forward), 1.0 - end
    return found


def _lobe(loops: LoopCurves, contact: Contact, place: int, forward: bool) -> float:
    """How far a branch leaves the other loop before its curve ends or meets that again."""
    curve, other = contact.curves[place], contact.curves[1 - place]
    start, end = contact.fractions[place][int(forward)], float(forward)
    for more in loops.contacts:
        for side in (0, 1):
            its_loop = loops.loop_of[more.curves[1 - side]]
            if more.curves[side] == curve and its_loop == loops.loop_of[other]:
                at = more.fractions[side][int(not forward)]
                if (forward and start < at < end) or (not forward and end < at < start):
                    end = at
    if abs(end - start) < 1e-9:
        curve = loops.following(curve, forward)
        start, end = (0.0, 1.0) if forward else (1.0, 0.0)
    points = loops.curves[curve].evaluate(np.linspace(start, end, LOBE_SAMPLES))
    loop = loops.loop_of[other]
    others = [k for k in loops.of_loop(loop) if k != curve]
    if not others:
        return float(np.linalg.norm(points - points[:1], axis=1).max())
    return float(np.min([closest(loops.curves[k], points)[1] for k in others], axis=0).max())
