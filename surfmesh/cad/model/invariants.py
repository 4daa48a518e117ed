"""What must be true of a CAD model, and how far a model is from it.

Indices are in range; loops are closed through their vertices, and in (u, v) apart from
tolerance; outer loops run counter-clockwise; every edge is used, ends at its vertices and lies
within its tolerance of its p-curves on the faces; every face is in a shell or listed as free.
"""

from __future__ import annotations

import math
from collections import Counter
from collections.abc import Iterator, Sequence
from typing import TYPE_CHECKING

import numpy as np

from surfmesh.cad.model.curve_samples import points_of, uv_of, walked
from surfmesh.geometry.inside_loops import nesting_depth
from surfmesh.geometry.rings import ring_area
from surfmesh.geometry.small_matrices import norm

if TYPE_CHECKING:
    from surfmesh.cad.model.cad_model import CadCoedge, CadEdge, CadFace, CadModel, CadVertex, Shell

OPEN_FRACTION = 0.05  # of the (u, v) box: a larger step between coedges is a gap even at a pole
NOISE = 1e-9  # of the model's diagonal: what evaluation may lose
ENDS = np.array([0.0, 1.0])
# where an edge is compared with its p-curves: programs fit these at 23 even points and measure
# there, so look in between, off the middles too, and above all near the ends
INTERIOR = np.array([0.3, 1.7, 4.3, 7.5, 10.7, 13.3, 16.7, 20.3, 21.7]) / 22
FRACTIONS = np.concatenate([ENDS, INTERIOR])


def step_between(here: CadCoedge, after: CadCoedge) -> np.ndarray:
    """(2,) How far the end of one coedge is from the start of the next, in (u, v)."""
    return after.walk(ENDS[:1])[0] - here.walk(ENDS[1:])[0]


def signed_area(loop: tuple[CadCoedge, ...], samples: int = 24) -> float:
    """Area in (u, v) that a loop runs round, positive counter-clockwise."""
    return ring_area(walked(loop, np.arange(samples) / samples).reshape(-1, 2))


def signed_areas(loops: Sequence[tuple[CadCoedge, ...]], samples: int = 24) -> list[float]:
    """``signed_area`` of each loop of a face."""
    rings = walked([c for loop in loops for c in loop], np.arange(samples) / samples)
    last = np.cumsum([len(loop) for loop in loops]).tolist()
    return [ring_area(rings[a:b].reshape(-1, 2)) for a, b in zip([0, *last], last)]


def broken(model: CadModel) -> Iterator[str]:
    """All broken invariants, one sentence each; numbers out of range hide the rest."""
    wrong = list(_broken_numbers(model))
    yield from wrong
    if wrong:
        return
    used = {coedge.edge for face in model.faces for coedge in face.coedges}
    for number in range(len(model.edges)):
        if number not in used:
            yield f"edge {number} is used by no face"
    for number, edge in enumerate(model.edges):
        yield from _broken_edge(model, number, edge)
    for number, face in enumerate(model.faces):
        yield from _broken_face(model, number, face)
    yield from _broken_solids(model)


def _broken_numbers(model: CadModel) -> Iterator[str]:
    vertices, edges, faces = len(model.vertices), len(model.edges), len(model.faces)
    for number, edge in enumerate(model.edges):
        if not (0 <= edge.start < vertices and 0 <= edge.end < vertices):
            yield f"edge {number} names a vertex that is not there"
    for number, face in enumerate(model.faces):
        if any(not 0 <= coedge.edge < edges for coedge in face.coedges):
            yield f"face {number} names an edge that is not there"
    shells = [shell for solid in model.solids for shell in solid.shells] + [*model.free_shells]
    held = [face for shell in shells for face, _ in shell] + [*model.free_faces]
    if any(not 0 <= face < faces for face in held):
        yield "a shell names a face that is not there"
    for number in sorted(set(range(faces)) - set(held)):
        yield f"face {number} is in no shell and is not listed as free"


def _broken_edge(model: CadModel, number: int, edge: CadEdge) -> Iterator[str]:
    if not (math.isfinite(edge.t0) and math.isfinite(edge.t1) and edge.t0 < edge.t1):
        yield f"edge {number} has the parameter range {edge.t0:g} to {edge.t1:g}"
        return
    if edge.degenerate:
        if edge.curve is not None or edge.start != edge.end:
            yield f"degenerate edge {number} is more than a point"
        return
    if edge.curve is None:
        yield f"edge {number} has no curve"
        return
    ends = edge.evaluate(ENDS, 0)[0]
    for point, vertex in zip(ends, (edge.start, edge.end)):
        gap = norm(point - model.vertices[vertex].point)
        if not gap <= model.vertices[vertex].tolerance + NOISE * model.diagonal:
            yield f"edge {number} ends {gap:.3g} {model.unit} from its vertex {vertex}"


def _broken_face(model: CadModel, number: int, face: CadFace) -> Iterator[str]:
    if not face.loops:
        yield f"face {number} has no loop"
        return
    uses = Counter(coedge.edge for coedge in face.coedges)
    for loop_number, loop in enumerate(face.loops):
        if not loop:
            yield f"loop {loop_number} of face {number} is empty"
            return
        place = f"loop {loop_number} of face {number}"
        for here, after in zip(loop, loop[1:] + loop[:1]):
            leaves, enters = model.edges[here.edge], model.edges[after.edge]
            end = leaves.start if here.reversed else leaves.end
            start = enters.end if after.reversed else enters.start
            if end != start:
                yield f"{place} is open between edges {here.edge} and {after.edge}"
        for coedge in loop:
            if coedge.seam != (uses[coedge.edge] > 1):
                yield f"{place} uses edge {coedge.edge} {uses[coedge.edge]} times, seam or not"
    areas = [signed_area(loop) for loop in face.loops]
    if not areas[0] > 0.0:
        yield f"loop 0 of face {number} does not run counter-clockwise (area {areas[0]:.3g})"
    for loop_number, (loop, area) in enumerate(zip(face.loops, areas)):
        slit = all(uses[coedge.edge] > 1 for coedge in loop)
        if loop_number and area > 0.0 and not slit and _is_hole(face.loops, loop_number):
            yield f"loop {loop_number} of face {number} runs counter-clockwise, a second outer loop"
    yield from _broken_pcurves(model, number, face)


def _is_hole(loops: Sequence[tuple[CadCoedge, ...]], number: int) -> bool:
    """Does the loop lie within an odd number of others? Else it is an outer one, or an island."""
    fraction = np.arange(24) / 24
    rings = [walked(loop, fraction).reshape(-1, 2) for loop in loops]
    return bool(nesting_depth(rings)[number] % 2)


def _broken_pcurves(model: CadModel, number: int, face: CadFace) -> Iterator[str]:
    """P-curves that leave a gap in (u, v), or deviate from their edge in space."""
    box = np.array(face.surface.domain)
    width = box[:, 1] - box[:, 0]
    if not (np.isfinite(box).all() and (width > 0.0).all()):
        yield f"face {number} has the (u, v) box {box.tolist()}"
        return
    coedges = list(face.coedges)
    uv = uv_of(coedges, FRACTIONS).reshape(-1, 2)
    r, r_u, r_v = face.surface.evaluate(uv, 1)
    if not np.isfinite(r).all():
        yield f"face {number} has points that are not finite"
        return
    slack = 1e-6 * width
    outside = ((uv < box[:, 0] - slack) | (uv > box[:, 1] + slack)).any(axis=1)
    if outside.any():
        yield f"face {number} has edges outside its (u, v) box, at {uv[outside][0].tolist()}"
    noise = NOISE * model.diagonal
    deviations = distances_to_edges(model.edges, model.vertices, coedges, r)
    for coedge, distance in zip(coedges, deviations):
        edge = model.edges[coedge.edge]
        reach = edge.tolerance
        if edge.degenerate:
            reach = max(reach, model.vertices[edge.start].tolerance)
        if not distance <= reach + noise:
            yield (
                f"edge {coedge.edge} lies {distance:.3g} {model.unit} off face {number}, "
                f"more than its tolerance {reach:.3g}"
            )
    speed = np.array([np.linalg.norm(d, axis=1).max() for d in (r_u, r_v)])
    for loop in face.loops:
        for here, after in zip(loop, loop[1:] + loop[:1]):
            step = np.abs(step_between(here, after))
            vertex = model.edges[here.edge].start if here.reversed else model.edges[here.edge].end
            reach = 2.0 * model.vertices[vertex].tolerance + noise
            if not ((step <= OPEN_FRACTION * width) | (step * speed <= reach)).all():
                yield (
                    f"face {number} is open in (u, v) between edges {here.edge} and "
                    f"{after.edge}, by ({step[0]:.3g}, {step[1]:.3g})"
                )


def distances_to_edges(
    edges: Sequence[CadEdge],
    vertices: Sequence[CadVertex],
    coedges: Sequence[CadCoedge],
    on_face: np.ndarray,
) -> np.ndarray:
    """(n,) Largest distance between each edge and its p-curve in space, at FRACTIONS of its range.

    on_face: (n * 11, 3) the p-curves, coedge after coedge.
    """
    used = [edges[coedge.edge] for coedge in coedges]
    real = np.array([edge.curve is not None for edge in used], bool)
    on_edge = np.empty((len(used), len(FRACTIONS), 3))
    on_edge[real] = points_of([edge for edge in used if edge.curve is not None], FRACTIONS)
    for place in np.flatnonzero(~real):
        on_edge[place] = vertices[used[place].start].point
    return np.linalg.norm(on_face.reshape(on_edge.shape) - on_edge, axis=2).max(axis=1)


def _broken_solids(model: CadModel) -> Iterator[str]:
    for number, solid in enumerate(model.solids):
        if not solid.shells:
            yield f"solid {number} has no shell"
        if not solid.volume > 0.0:
            yield f"solid {number} has the volume {solid.volume:.3g}"
        if solid.closed != is_closed(model.faces, solid.shells, model.edges):
            yield f"solid {number} is said to be {'' if solid.closed else 'not '}closed"


def is_closed(faces: Sequence[CadFace], shells: Sequence[Shell], edges: Sequence[CadEdge]) -> bool:
    """Whether every edge of the shells is run along as often one way as the other."""
    balance: Counter[int] = Counter()
    for shell in shells:
        for number, against in shell:
            face = faces[number]
            for coedge in face.coedges:
                if not edges[coedge.edge].degenerate:
                    way = coedge.reversed ^ face.reversed ^ against
                    balance[coedge.edge] += -1 if way else 1
    return not any(balance.values())
