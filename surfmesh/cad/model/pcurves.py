"""P-curves that follow their edge more closely than those of the file.

Programs make a p-curve from a few points and state the deviation at those; in between it can be
ten thousand times worse, mostly because the p-curve runs at another pace than its edge, or goes
round from another start. Then the points of the face next to those of the edge give a better one.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from surfmesh._core.surfaces import spline_through_points
from surfmesh.cad.model.cad_model import CadCoedge, CadEdge
from surfmesh.cad.model.invariants import ENDS
from surfmesh.geometry.cad_surfaces.nurbs import BSplineCurve
from surfmesh.geometry.differential.projection import closest_point
from surfmesh.geometry.surface import Surface

SPANS = (32, 128, 512)  # of the new p-curve, the first that is good enough
BETWEEN = (0.3, 0.7)  # of a span: an error of pace may vanish in the middle
STEPS = 8  # towards the nearest point
BETTER = 0.5  # of the old deviation, or the old p-curve stays


def follows(
    surface: Surface, edge: CadEdge, coedge: CadCoedge, reach: float, is_loop: bool = False
) -> CadCoedge:
    """The coedge with a p-curve within ``reach`` of its edge, or as near as its face allows.

    The ends stay where they were, so that loops stay closed; is_loop: it is one by itself, and may
    start elsewhere. The same coedge when no p-curve is much better. The edge is not degenerate.
    """
    best, deviation = coedge, np.inf
    ends = coedge.uv(ENDS)
    for spans in SPANS:
        fraction = np.linspace(0.0, 1.0, spans + 1)
        uv, _ = _closest(surface, edge, coedge, fraction)
        uv[[0, -1]] = uv[0] + (ends - ends[0]) if is_loop else ends
        parameters = coedge.p0 + fraction * (coedge.p1 - coedge.p0)
        trial = replace(coedge, pcurve=BSplineCurve(*spline_through_points(parameters, uv, 3)))
        between = np.sort(np.concatenate([fraction[:-1] + at / spans for at in BETWEEN]))
        trial_deviation = _deviation(surface, edge, trial, between)
        if best is coedge:
            deviation = _deviation(surface, edge, coedge, between)
        if trial_deviation < BETTER * deviation:
            best, deviation = trial, trial_deviation
        _, distance = _closest(surface, edge, trial, between)
        if deviation <= max(reach, 1.1 * distance.max()):  # the face itself is no nearer
            break
    return best


def _closest(
    surface: Surface, edge: CadEdge, coedge: CadCoedge, fraction: np.ndarray
) -> tuple[np.ndarray, np.ndarray]:
    points = edge.evaluate(fraction, 0)[0]
    uv, distance, _ = closest_point(surface, points, coedge.uv(fraction), STEPS, margin=0.0)
    return uv, distance


def _deviation(surface: Surface, edge: CadEdge, coedge: CadCoedge, fraction: np.ndarray) -> float:
    points = edge.evaluate(fraction, 0)[0]
    (on_face,) = surface.evaluate(coedge.uv(fraction), 0)
    return float(np.linalg.norm(on_face - points, axis=1).max())
