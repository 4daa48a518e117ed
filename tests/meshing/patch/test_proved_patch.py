"""Cuts of triangles that are not proved to keep to the chord."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

import surfmesh as sm
from surfmesh.accuracy.face_triangles import FaceTriangles, twins_of
from surfmesh.accuracy.proof import proved_distances
from surfmesh.meshing.patch.proved_patch import PASSES, Patch, cut_until_proved
from surfmesh.result.connectivity import connect


def patch_of(mesh):
    return Patch(
        mesh.points, mesh.triangles, mesh.uv_points, mesh.uv_triangles, mesh.sizes,
        mesh.metric_root_3d,
    )  # fmt: skip


def bounds(surface, patch, chord):
    table = connect(patch.triangles)
    twins = twins_of(table.half_edges, table.uses, len(patch.triangles))
    corners = np.ascontiguousarray(patch.points[patch.triangles])
    uv = np.ascontiguousarray(patch.uv[patch.uv_triangles])
    face = FaceTriangles(corners, uv, patch.triangles, twins)
    return proved_distances(surface, face, np.full(len(corners), chord)).bound


def areas(patch):
    a, b, c = np.moveaxis(patch.uv[patch.uv_triangles], 1, 0)
    return np.linalg.det(np.stack([b - a, c - a], axis=1))


@settings(max_examples=10, deadline=None)
@given(name=st.sampled_from(["torus", "monkey_saddle", "two_peaks"]), part=st.floats(0.002, 0.015))
def test_a_few_triangles_are_cut_until_they_are_proved(name, part):
    surface = sm.load(name)
    mesh = sm.mesh(surface, sm.Sizing(size=0.3 if name == "torus" else 0.15))
    before = patch_of(mesh)
    chord = float(np.quantile(bounds(surface, before, np.inf), 1.0 - part))
    patch, asked = cut_until_proved(surface, sm.Sizing(chord=chord, proof=True), before)
    first, left = (np.count_nonzero(bounds(surface, x, chord) > chord) for x in (before, patch))
    assert left == (0 if asked is None else len(asked.sizes)) <= first
    old, new = len(before.triangles), len(patch.triangles)
    assert old + 2 * min(left < first, 1) <= new <= old + 2 * PASSES * max(4, 0.02 * new)
    # what was there is there still, and the same part of (u, v) is covered once
    assert np.array_equal(patch.points[: len(before.points)], before.points)
    assert (areas(patch) > 0.0).all()
    assert areas(patch).sum() == pytest.approx(areas(before).sum(), rel=1e-12)
    two, one = connect(patch.triangles), connect(before.triangles)
    assert np.array_equal(np.bincount(two.uses)[:2], np.bincount(one.uses)[:2])  # rims as before
    (on_surface,) = surface.evaluate(patch.uv[len(before.uv) :], 0)
    assert np.array_equal(on_surface, patch.points[len(before.points) :])


def test_all_are_proved_where_no_rim_is_in_the_way():
    surface = sm.load("torus")
    before = patch_of(sm.mesh(surface, sm.Sizing(size=0.5)))
    chord = float(np.sort(bounds(surface, before, 0.0))[-8])
    assert np.count_nonzero(bounds(surface, before, chord) > chord) > 0
    patch, asked = cut_until_proved(surface, sm.Sizing(chord=chord, proof=True), before)
    assert asked is None and len(patch.triangles) > len(before.triangles)
    assert (bounds(surface, patch, chord) <= chord).all()


def test_where_many_are_not_proved_sizes_are_asked_for_and_nothing_is_cut():
    surface = sm.load("torus")
    before = patch_of(sm.mesh(surface, sm.Sizing(size=0.5)))
    chord = float(np.median(bounds(surface, before, np.inf)))
    patch, asked = cut_until_proved(surface, sm.Sizing(chord=chord, proof=True), before)
    assert patch is before
    assert len(asked.sizes) > 0.25 * len(before.triangles)


def test_no_half_is_shorter_than_the_least_size():
    surface = sm.load("torus")
    before = patch_of(sm.mesh(surface, sm.Sizing(size=0.5)))
    chord = float(np.quantile(bounds(surface, before, np.inf), 0.99))
    sizing = sm.Sizing(chord=chord, min_size=0.4, proof=True)
    assert cut_until_proved(surface, sizing, before)[0] is before


def test_without_proof_nothing_is_looked_at():
    mesh = sm.mesh(sm.load("torus"), sm.Sizing(size=0.5))
    before = patch_of(mesh)
    assert cut_until_proved(mesh.surfaces[0], sm.Sizing(chord=1e-6), before) == (before, None)
