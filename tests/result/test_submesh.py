"""One operation renumbers all that a mesh holds: nobody copies fields by hand."""

from dataclasses import fields

import cadquery as cq
import numpy as np
import pytest

import surfmesh as sm
from surfmesh.result.surface_mesh import SurfaceMesh

OF_VERTICES = {"points", "sizes", "vertex_ids"}
OF_CORNERS = {"uv_points", "uv_triangles", "inverse_sizes"}
OF_TRIANGLES = {"triangles", "face_ids", "solid_ids"}
OF_EDGES = {"edge_segments", "edge_ids", "edge_shares", "mid_points"}
OF_ALL = {
    "surfaces", "sizing", "promises", "seconds", "warnings", "one_sided", "facts",
    "turned_faces", "narrow_faces", "groups", "edge_curves",
}  # fmt: skip


def test_every_field_is_known_to_it():
    names = {field.name for field in fields(SurfaceMesh)}
    assert names == OF_VERTICES | OF_CORNERS | OF_TRIANGLES | OF_EDGES | OF_ALL, (
        "teach SurfaceMesh.submesh the new field, then this test"
    )


@pytest.mark.parametrize("ratio", [1.0, 8.0])
@pytest.mark.parametrize("order", [1, 2])
def test_a_part_keeps_all_that_belongs_to_it(ratio, order):
    tube = sm.from_cadquery(cq.Workplane().circle(5).circle(4).extrude(4))
    mesh = sm.mesh(tube, sm.Sizing(chord=0.2, anisotropy=ratio), order=order)
    kept = mesh.face_ids <= 1
    part = mesh.submesh(kept)
    assert part.check() is None and len(part.triangles) == kept.sum()
    assert np.array_equal(part.points[part.triangles], mesh.points[mesh.triangles[kept]])
    assert np.array_equal(part.uv, mesh.uv[kept])
    assert np.array_equal(part.sizes[part.triangles], mesh.sizes[mesh.triangles[kept]])
    assert np.array_equal(part.solid_ids, mesh.solid_ids[kept])
    if ratio > 1:
        w = mesh.inverse_sizes[mesh.uv_triangles[kept]]
        assert np.array_equal(part.inverse_sizes[part.uv_triangles], w)
    if order == 2:
        old = {tuple(sorted(map(tuple, mesh.points[e]))): m
               for e, m in zip(mesh.edges, mesh.mid_points)}  # fmt: skip
        for edge, middle in zip(part.edges, part.mid_points):
            assert np.array_equal(old[tuple(sorted(map(tuple, part.points[edge])))], middle)
    known = set(map(tuple, part.edges.tolist()))
    segments = {tuple(sorted(pair)) for pair in part.edge_segments.tolist()}
    assert segments <= known and len(segments) >= len(part.boundary_edges)
    used = part.vertex_ids >= 0
    assert np.array_equal(part.points[part.vertex_ids[used]], mesh.points[mesh.vertex_ids[used]])
    assert np.array_equal(mesh.submesh(np.ones(len(mesh.triangles), bool)).points, mesh.points)
    assert np.array_equal(mesh.submesh(np.flatnonzero(kept)[::-1]).triangles.shape, (kept.sum(), 3))


@pytest.mark.parametrize("order", [1, 2])
@pytest.mark.parametrize("ratio", [1.0, 8.0])
def test_stretched_meshes_are_simplified_too(ratio, order):
    outside = [(0, 0), (100, 0), (100, 30), (50.01, 30), (50, 30.01), (0, 30.01)]
    part = cq.Workplane().polyline(outside).close().extrude(20).edges("|Z and >X").fillet(5)
    sizing = sm.Sizing(chord=0.1, max_size=10.0, min_size=0.5, anisotropy=ratio)
    mesh = sm.mesh(sm.from_cadquery(part), sizing, simplify=True, order=order)
    report = sm.check(mesh)
    assert any("has vanished" in text for text in mesh.warnings)
    assert report.closed and report.euler == 2 and report.problems == ()
    assert mesh.order == order and mesh.check() is None
    assert (mesh.inverse_sizes is not None) == (ratio > 1)
