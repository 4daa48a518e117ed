"""Tolerances that are true, and p-curves that keep to them.

Files state how far edges deviate from their faces as it was measured at a few points. Here it is
measured anew; p-curves that stray are replaced, and where that does not help tolerances are raised.
"""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import replace
from operator import is_
from typing import Any

import numpy as np

from surfmesh.cad.model.cad_model import CadCoedge, CadEdge, CadFace, CadVertex
from surfmesh.cad.model.curve_samples import points_of, uv_of
from surfmesh.cad.model.invariants import ENDS, FRACTIONS, NOISE, distances_to_edges
from surfmesh.cad.model.loops import Loop
from surfmesh.cad.model.pcurves import follows
from surfmesh.geometry.cad_surfaces.curve_on_surface import CurveOnSurface
from surfmesh.geometry.cad_surfaces.face_surface import FaceSurface
from surfmesh.geometry.small_matrices import norm
from surfmesh.geometry.surface import Domain

REPORTED = 10.0  # times its tolerance: an edge that deviates by more is reported
LOOSE = 1e-4  # of its length: a curve that deviates so far from all its faces may be replaced
AGREE = 0.5  # of that distance: p-curves that lie this near each other are believed instead
CHORDS = 256  # that measure the length of a curve on a face
MANY = 12  # numbers that a sentence lists


def deviations(
    edges: list[CadEdge], vertices: list[CadVertex], faces: list[CadFace]
) -> list[np.ndarray]:
    """For each face (n,) how far the edge of each coedge deviates from the face in space."""
    coedges = [list(face.coedges) for face in faces]
    every = [coedge for own in coedges for coedge in own]
    ends = np.cumsum([len(own) for own in coedges])[:-1]
    pcurves = np.split(uv_of(every, FRACTIONS), ends)
    on_faces = [face.surface.evaluate(uv.reshape(-1, 2), 0)[0] for face, uv in zip(faces, pcurves)]
    return np.split(distances_to_edges(edges, vertices, every, np.concatenate(on_faces)), ends)


class Measured:
    """``deviations`` of lists that change in place: measured anew once an entry is another."""

    def __init__(
        self, edges: list[CadEdge], vertices: list[CadVertex], faces: list[CadFace]
    ) -> None:
        self.edges, self.vertices, self.faces = edges, vertices, faces
        self._of: list[Any] = []
        self._found: list[np.ndarray] = []

    def deviations(self) -> list[np.ndarray]:
        """What ``deviations`` says of the lists as they are now."""
        entries = [*self.edges, *self.vertices, *self.faces]
        if len(entries) != len(self._of) or not all(map(is_, entries, self._of)):
            self._of = entries
            self._found = deviations(self.edges, self.vertices, self.faces)
        return self._found


def pcurves_that_follow(measured: Measured, unit: str) -> list[str]:
    """Replace, in place, p-curves that deviate from their edge by more than the file states.

    One that makes up a loop by itself must not stray at all: programs raise the tolerance of a
    circle to its diameter where its p-curve starts right across.
    """
    edges, faces = measured.edges, measured.faces
    replaced, loops_of_one, worst = set(), set(), 0.0
    for number, distances in enumerate(measured.deviations()):
        face, better = faces[number], {}
        for coedge, distance in zip(face.coedges, distances):
            edge = edges[coedge.edge]
            is_loop = (coedge,) in face.loops
            allowed, noise = REPORTED * edge.tolerance, NOISE * edge.length
            if is_loop:
                allowed = min(allowed, LOOSE * edge.length)
            if edge.curve is None or distance <= allowed:
                continue
            reach = noise if is_loop else max(edge.tolerance, noise)
            new = follows(face.surface, edge, coedge, reach, is_loop)
            if new is not coedge:
                better[id(coedge)] = new
                replaced.add(coedge.edge)
                if is_loop:
                    loops_of_one.add(coedge.edge)
                worst = max(worst, distance)
        if better:
            loops = tuple(
                tuple(better.get(id(coedge), coedge) for coedge in loop) for loop in face.loops
            )
            faces[number] = replace(face, surface=widened(face.surface, loops), loops=loops)
    if not replaced:
        return []
    _lower_tolerances(measured, loops_of_one)
    numbers = listed([str(number) for number in sorted(replaced)])
    return [
        f"{'edges' if len(replaced) > 1 else 'edge'} {numbers}: p-curve on a face replaced, "
        f"which strayed by up to {worst:.2g} {unit}"
    ]


def _lower_tolerances(measured: Measured, numbers: set[int]) -> None:
    """State, in place, tolerances of edges as they are measured, where they are stated larger."""
    true = _farthest(measured, np.array([NOISE * edge.length for edge in measured.edges]))
    for number in numbers:
        edge = measured.edges[number]
        tolerance = min(edge.tolerance, float(true[number]))
        measured.edges[number] = replace(edge, tolerance=tolerance)


def _farthest(measured: Measured, least: np.ndarray) -> np.ndarray:
    """How far (e,) the p-curves of each edge stray from it, no less than ``least`` (e,)."""
    users = [coedge.edge for face in measured.faces for coedge in face.coedges]
    found = least.copy()
    np.maximum.at(found, users, np.concatenate(measured.deviations()))
    return found


def curves_on_their_faces(measured: Measured, unit: str) -> list[str]:
    """Replace, in place, curves that deviate from their faces where p-curves agree.

    The border of a single face lies on that face, whatever the file says.
    """
    edges = measured.edges
    users: dict[int, list[tuple[CadFace, CadCoedge]]] = {}
    loose: dict[int, float] = {}
    for face, distances in zip(measured.faces, measured.deviations()):
        for coedge, distance in zip(face.coedges, distances):
            edge = edges[coedge.edge]
            users.setdefault(coedge.edge, []).append((face, coedge))
            if edge.curve is not None and distance > LOOSE * edge.length:
                loose[coedge.edge] = max(distance, loose.get(coedge.edge, 0.0))
    replaced = []
    for number, distance in loose.items():
        on_face = [
            face.surface.evaluate(coedge.uv(FRACTIONS), 0)[0] for face, coedge in users[number]
        ]
        spread = max(float(np.linalg.norm(i - on_face[0], axis=1).max()) for i in on_face)
        if spread > AGREE * distance:
            continue
        face, coedge = users[number][0]
        edge = edges[number]
        rate = (coedge.p1 - coedge.p0) / (edge.t1 - edge.t0)
        shift = coedge.p0 - rate * edge.t0
        curve = CurveOnSurface(face.surface, coedge.pcurve, shift, rate)
        points = curve.evaluate(edge.parameters(np.linspace(0.0, 1.0, CHORDS + 1)), 0)[0]
        length = float(np.linalg.norm(np.diff(points, axis=0), axis=1).sum())
        tolerance = max(spread, NOISE * length)
        edges[number] = replace(edge, curve=curve, length=length, tolerance=tolerance)
        replaced.append(number)
    if not replaced:
        return []
    _vertices_at_their_edges(measured, replaced)
    several = len(replaced) > 1
    return [
        f"{'edges' if several else 'edge'} {listed([str(n) for n in sorted(replaced)])}: curve in "
        f"space replaced by the p-curve on a face, which it strayed from by up to "
        f"{max(loose[n] for n in replaced):.2g} {unit}"
    ]


def _vertices_at_their_edges(measured: Measured, replaced: list[int]) -> None:
    """Put vertices, in place, where all their edges end, of which these have new curves.

    The vertex of an edge stood at the end of the curve that is gone: of a circle whose p-curves
    start at another of its points, right across.
    """
    edges, vertices = measured.edges, measured.vertices
    at_replaced = {v for number in replaced for v in (edges[number].start, edges[number].end)}
    ends: dict[int, list[np.ndarray]] = {vertex: [] for vertex in at_replaced}
    held = {v for edge in edges if edge.curve is None for v in (edge.start, edge.end)}  # at poles
    for edge in edges:
        if edge.curve is not None and not at_replaced.isdisjoint((edge.start, edge.end)):
            for vertex, point in zip((edge.start, edge.end), edge.evaluate(ENDS)[0]):
                if vertex in at_replaced:
                    ends[vertex].append(point)
    for vertex in sorted(at_replaced - held):
        known, points = vertices[vertex], ends[vertex]
        distance = min(norm(point - known.point) for point in points)
        if max(norm(point - points[0]) for point in points) < AGREE * distance:
            vertices[vertex] = replace(known, point=np.mean(points, axis=0))


def tolerances_that_hold(measured: Measured, unit: str) -> list[str]:
    """Raise tolerances, in place, to what is measured: of edges from their p-curves, of vertices.

    Files state what was measured at a few points of an edge; in between it may be worse.
    """
    edges, vertices = measured.edges, measured.vertices
    stated = np.array([edge.tolerance for edge in edges])
    true = _farthest(measured, stated)
    for number in np.flatnonzero(true > stated):
        edges[number] = replace(edges[number], tolerance=float(true[number]))
    real = [edge for edge in edges if edge.curve is not None]
    places = points_of(real, ENDS)
    gaps = np.linalg.norm(places - _ends_of(real, vertices), axis=2)
    held = np.array([[vertices[v].tolerance for v in (e.start, e.end)] for e in real])
    for place in np.flatnonzero((gaps > (1.0 - NOISE) * held.reshape(-1, 2)).any(axis=1)):
        edge = real[place]
        for vertex, point in zip((edge.start, edge.end), places[place]):
            known = vertices[vertex]
            gap = norm(point - known.point)
            if gap > known.tolerance:
                vertices[vertex] = replace(known, tolerance=gap * (1.0 + NOISE))
    far = np.flatnonzero(true > REPORTED * stated)
    if not len(far):
        return []
    worst = far[np.argmax(true[far])]
    return [
        f"{len(far)} edge{'s lie' if len(far) > 1 else ' lies'} further off the faces than "
        f"the file states, edge {worst} most: {true[worst]:.2g} {unit} instead of "
        f"{stated[worst]:.2g}; tolerances raised"
    ]


def _ends_of(edges: list[CadEdge], vertices: list[CadVertex]) -> np.ndarray:
    """(n, 2, 3) The vertices at the ends of edges."""
    points = [[vertices[v].point for v in (edge.start, edge.end)] for edge in edges]
    return np.array(points).reshape(-1, 2, 3)


def widened(surface: FaceSurface, loops: Iterable[Loop]) -> FaceSurface:
    """The surface with room for all samples of the loops in its domain."""
    lo, hi = joined(surface.domain, loops)
    domain = ((float(lo[0]), float(hi[0])), (float(lo[1]), float(hi[1])))
    return surface if domain == surface.domain else surface.with_domain(domain)


def joined(domain: Domain, loops: Iterable[Loop]) -> tuple[np.ndarray, np.ndarray]:
    samples = uv_of([coedge for loop in loops for coedge in loop], FRACTIONS).reshape(-1, 2)
    (u0, u1), (v0, v1) = domain
    lo = np.minimum(samples.min(axis=0), (u0, v0))
    return lo, np.maximum(samples.max(axis=0), (u1, v1))


def listed(names: list[str]) -> str:
    more = f" and {len(names) - MANY} more" if len(names) > MANY else ""
    return ", ".join(names[:MANY]) + more
