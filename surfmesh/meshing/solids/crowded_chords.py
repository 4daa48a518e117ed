r"""Chords that two faces made between the same nodes are cut in all faces but one.

  a               a          Where two faces have one tangent plane and their common edges leave
 / \             /|\         a node at a narrow angle, both put one triangle into the corner, of
p---q   -->     p-m-q        whatever size. A new vertex amid the chord p q, on the face that
 \ /             \|/         bends more, tells them apart.
  b               b
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from surfmesh._core.faces import triangles_of_shared
from surfmesh.cad.model.cad_model import CadModel
from surfmesh.cad.model.model_arrays import model_arrays
from surfmesh.geometry.small_matrices import norm
from surfmesh.meshing.solids.joining import crowded_chords, shared_vertices
from surfmesh.result.surface_mesh import SurfaceMesh

IN_ONE_PLANE = 1e-9
"""Sine of the angle up to which an edge lies in the plane of a triangle."""


def with_crowded_chords_cut(model: CadModel, mesh: SurfaceMesh) -> SurfaceMesh:
    """The mesh with the chords cut that more faces use than should: the same mesh if none are.

    Left as they are: chords on the border of one of the faces.
    """
    chords = crowded_chords(model, mesh)
    for first, last in np.sort(chords, axis=1).tolist():
        mesh = _cut_in_all_but_one(mesh, first, last)
    return mesh


def with_flat_corners_cut(model: CadModel, mesh: SurfaceMesh) -> SurfaceMesh:
    """The mesh with those chords cut whose triangle alone fills a corner of its face and lies in
    the plane of the triangles that another face has in the same corner: they would overlap."""
    for face, corner, first, last in _lone_corners(model, mesh):
        if _lies_in_plane_beside(model, mesh, face, corner, first, last):
            users = np.flatnonzero(
                (mesh.triangles == first).any(axis=1) & (mesh.triangles == last).any(axis=1)
            )
            chord = _chord(mesh, face, users[mesh.face_ids[users] == face], first, last)
            mesh = mesh if chord is None else _cut(mesh, chord, first, last)
    return mesh


class _LoneCorner(NamedTuple):
    """A triangle with two sides on edges of the model: between them a face has no other."""

    face: int
    corner: int
    first: int
    last: int


def _lone_corners(model: CadModel, mesh: SurfaceMesh) -> list[_LoneCorner]:
    """Those where another face has both edges too."""
    if mesh.edge_segments is None or not len(mesh.edge_segments):
        return []
    assert mesh.vertex_ids is not None and mesh.edge_ids is not None  # noqa: S101 for mypy
    at_vertex = np.zeros(len(mesh.points), bool)
    at_vertex[mesh.vertex_ids[mesh.vertex_ids >= 0]] = True
    rows = triangles_of_shared(mesh.triangles, shared_vertices(mesh).view(np.uint8))
    rows = rows[_has_any(at_vertex, mesh.triangles[rows])]
    beside = np.flatnonzero(_has_any(at_vertex, mesh.edge_segments))
    if not len(rows) or not len(beside):
        return []
    count = np.int64(len(mesh.points))
    ends = np.sort(mesh.edge_segments[beside], axis=1).astype(np.int64)
    keys = ends[:, 0] * count + ends[:, 1]
    order = np.argsort(keys, kind="stable")
    corners = mesh.triangles[rows]
    sides = np.sort(np.stack([corners, np.roll(corners, -1, axis=1)], axis=2), axis=2)
    wanted = sides[:, :, 0].astype(np.int64) * count + sides[:, :, 1]
    place = np.minimum(np.searchsorted(keys[order], wanted), len(keys) - 1)
    is_on_edge = keys[order][place] == wanted
    edges = mesh.edge_ids[beside[order[place]]]
    found = []
    may_have_both = _may_have_both(model, edges, mesh.face_ids[rows])
    for row in np.flatnonzero((is_on_edge.sum(axis=1) == 2) & may_have_both).tolist():
        free = int(is_on_edge[row].argmin())  # the side from corner free on
        one, two = (int(edges[row, (free + k) % 3]) for k in (1, 2))
        face = int(mesh.face_ids[rows[row]])
        if set(model.faces_of_edge(one)) & set(model.faces_of_edge(two)) - {face}:
            first, last, corner = (int(corners[row, (free + k) % 3]) for k in range(3))
            found.append(_LoneCorner(face, corner, first, last))
    return found


def _has_any(flags: np.ndarray, rows: np.ndarray) -> np.ndarray:
    """(n,) bool: has any number in rows (n, k) its flag? Column by column, as k is small."""
    found = flags[rows[:, 0]]
    for column in rows.T[1:]:
        found |= flags[column]
    return found


def _may_have_both(model: CadModel, edges: np.ndarray, faces: np.ndarray) -> np.ndarray:
    """(n,) bool: may a face beside each of ``faces`` (n,) have two of its edges (n, 3)? An edge of
    two faces tells the other one."""
    arrays = model_arrays(model)
    lowest = np.full(len(model.edges), len(model.faces))
    highest, uses = np.full(len(lowest), -1), np.bincount(arrays.coedge_edge, minlength=len(lowest))
    np.minimum.at(lowest, arrays.coedge_edge, arrays.coedge_face)
    np.maximum.at(highest, arrays.coedge_edge, arrays.coedge_face)
    other = (lowest + highest)[edges] - faces[:, None]
    return (other == np.roll(other, 1, axis=1)).any(axis=1) | (uses[edges] > 2).any(axis=1)


def _lies_in_plane_beside(
    model: CadModel, mesh: SurfaceMesh, face: int, corner: int, first: int, last: int
) -> bool:
    """Has another face an edge from the corner that lies in the triangle's plane, between its
    sides?"""
    beside = np.flatnonzero((mesh.triangles == corner).any(axis=1) & (mesh.face_ids != face))
    of_first = set(mesh.face_ids[beside[(mesh.triangles[beside] == first).any(axis=1)]].tolist())
    of_both = of_first & set(
        mesh.face_ids[beside[(mesh.triangles[beside] == last).any(axis=1)]].tolist()
    )
    around = beside[np.isin(mesh.face_ids[beside], list(of_both))]
    others = np.setdiff1d(mesh.triangles[around], [corner, first, last])
    a, b = mesh.points[first] - mesh.points[corner], mesh.points[last] - mesh.points[corner]
    ways = mesh.points[others] - mesh.points[corner]
    normal = np.cross(a, b)
    size = norm(normal) * np.linalg.norm(ways, axis=1)
    is_flat = np.abs((ways * normal).sum(axis=1)) <= IN_ONE_PLANE * size
    after_first = (np.cross(a, ways) * normal).sum(axis=1) > 0.0
    before_last = (np.cross(ways, b) * normal).sum(axis=1) > 0.0
    return bool((is_flat & after_first & before_last).any())


class _Chord(NamedTuple):
    """Of one face: its two triangles there, the places (2, 2) in (u, v) of the ends in both by
    number, the place amid them and the point there."""

    two: np.ndarray
    ends: np.ndarray
    uv: np.ndarray
    point: np.ndarray


def _cut_in_all_but_one(mesh: SurfaceMesh, first: int, last: int) -> SurfaceMesh:
    at = (mesh.triangles == first).any(axis=1) & (mesh.triangles == last).any(axis=1)
    users = np.flatnonzero(at)
    faces = mesh.face_ids[users]
    found = [
        chord for face in np.unique(faces).tolist()
        if (chord := _chord(mesh, face, users[faces == face], first, last)) is not None
    ]  # fmt: skip
    # the flattest stays as it is: the others leave its plane
    amid = mesh.points[[first, last]].mean(axis=0)
    found.sort(key=lambda chord: norm(chord.point - amid))
    for chord in found[1:]:
        mesh = _cut(mesh, chord, first, last)
    return mesh


def _chord(mesh: SurfaceMesh, face: int, two: np.ndarray, first: int, last: int) -> _Chord | None:
    """None on the border of a face, and where its triangles lie on two sides of a seam."""
    assert mesh.uv_points is not None and mesh.uv_triangles is not None  # noqa: S101
    if len(two) != 2:
        return None
    corners, images = mesh.triangles[two], mesh.uv_triangles[two]
    ends = np.array([images[corners == node] for node in (first, last)])
    if (ends[:, 0] != ends[:, 1]).any():
        return None
    uv = mesh.uv_points[ends[:, 0]].mean(axis=0)
    return _Chord(two, ends, uv, mesh.surfaces[face].evaluate(uv[None], 0)[0])


def _cut(mesh: SurfaceMesh, chord: _Chord, first: int, last: int) -> SurfaceMesh:
    """A vertex amid a chord of two triangles of a face; the new triangles come last."""
    assert mesh.uv_points is not None and mesh.uv_triangles is not None  # noqa: S101
    two, ends = chord.two, chord.ends
    corners, images = mesh.triangles, mesh.uv_triangles
    new, new_uv = len(mesh.points), len(mesh.uv_points)
    triangles = np.vstack([corners, np.where(corners[two] == first, new, corners[two])])
    triangles[two] = np.where(corners[two] == last, new, corners[two])
    images = np.vstack([images, np.where(images[two] == ends[0, 0], new_uv, images[two])])
    images[two] = np.where(images[two] == ends[1, 0], new_uv, images[two])
    sizes, roots, solids = mesh.sizes, mesh.metric_root_3d, mesh.solid_ids
    return mesh.replaced(
        points=np.vstack([mesh.points, chord.point]),
        triangles=triangles,
        uv_points=np.vstack([mesh.uv_points, chord.uv]),
        uv_triangles=images,
        face_ids=np.append(mesh.face_ids, mesh.face_ids[two]),
        solid_ids=None if solids is None else np.vstack([solids, solids[two]]),
        sizes=None if sizes is None else np.append(sizes, sizes[[first, last]].mean()),
        metric_root_3d=(
            None if roots is None else np.vstack([roots, roots[ends[:, 0]].mean(axis=0)])
        ),
    )
