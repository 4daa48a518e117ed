"""One operation renumbers all that a mesh holds: nobody copies fields by hand."""

from dataclasses import fields, replace

import cadquery as cq
import numpy as np
import pytest

import surfmesh as sm
from surfmesh.result.mesh_fields import MeshFields
from surfmesh.result.mesh_part import (
    ANY,
    CAD_VERTEX,
    CORNER,
    EDGE,
    FACE,
    SEGMENT,
    TRIANGLE,
    VERTEX,
    array_fields,
)
from surfmesh.result.surface_mesh import SurfaceMesh

PARTS = ("parametrisation", "model_links", "edge_links", "record")


@pytest.fixture(scope="module")
def rich():
    """A mesh that holds every array there is."""
    tube = sm.from_cadquery(cq.Workplane().circle(5).circle(4).extrude(4))
    mesh = sm.mesh(tube, sm.Sizing(chord=0.2, anisotropy=8.0), order=2)
    return mesh.replaced(promises=np.ones((4, 3)))


def held(mesh):
    """Names and values of all fields of the mesh and of its parts, and who holds them."""
    for owner in (mesh, *(getattr(mesh, part) for part in PARTS)):
        for item in fields(owner):
            if item.name not in PARTS:
                yield item.name, getattr(owner, item.name), owner


def test_every_array_says_what_its_rows_are(rich):
    for name, value, owner in held(rich):
        declared = name in dict(array_fields(owner))
        assert declared == isinstance(value, np.ndarray), f"{name}: declare it with rows(...)"


def test_every_field_is_an_attribute_of_the_mesh_and_a_keyword(rich):
    known = MeshFields.__annotations__
    for name, value, _ in held(rich):
        assert getattr(rich, name) is value
        assert name in known or name in ("points", "triangles")


def test_every_array_is_cut_down_and_numbered_anew(rich):
    part = rich.submesh(rich.face_ids == 0)
    counts = {
        VERTEX: len(part.points), TRIANGLE: len(part.triangles), CORNER: len(part.uv_points),
        EDGE: len(part.edges), SEGMENT: len(part.edge_ids), FACE: len(part.surfaces),
        CAD_VERTEX: len(rich.vertex_ids), ANY: len(rich.promises),
    }  # fmt: skip
    assert len(part.edge_ids) < len(rich.edge_ids)
    for name, value, owner in held(part):
        kind = dict(array_fields(owner)).get(name)
        if kind is not None:
            assert len(value) == counts[kind.of], name
            if kind.holds:
                kept = value[value >= 0]
                assert np.array_equal(np.unique(kept), np.arange(counts[kind.holds])) or (
                    name in ("edge_segments", "vertex_ids") and kept.max() < counts[VERTEX]
                ), name
        else:
            assert value is getattr(rich, name) or value == getattr(rich, name), name


def test_fields_may_be_replaced_each_by_itself(rich):
    bare = replace(rich, sizes=None, warnings=["one"], mid_points=None)
    assert bare.sizes is None and bare.warnings == ("one",) and bare.order == 1
    assert bare.parametrisation is rich.parametrisation and bare.sizing is rich.sizing
    for name, value, _ in held(bare.replaced(sizes=rich.sizes, mid_points=rich.mid_points)):
        assert value is getattr(rich, name) or name in ("warnings", "seconds"), name
    flat = rich.replaced(uv_points=None, uv_triangles=None, metric_root_3d=None)
    assert flat.parametrisation is None and flat.uv is None
    with pytest.raises(TypeError, match="no colour"):
        SurfaceMesh(points=rich.points, triangles=rich.triangles, colour=1)
    with pytest.raises(ValueError, match=r"uv_triangles has shape .*, expected \("):
        rich.replaced(uv_triangles=rich.uv_triangles[1:])
    with pytest.raises(ValueError, match="metric_root_3d given without uv_points"):
        SurfaceMesh(points=np.eye(3), triangles=[(0, 1, 2)], metric_root_3d=np.ones((3, 6)))


def test_old_names_are_read_and_taken_with_a_warning(rich):
    with pytest.warns(DeprecationWarning, match="inverse_sizes is called metric_root_3d") as said:
        assert rich.inverse_sizes is rich.metric_root_3d
    assert said[0].filename == __file__
    with pytest.warns(DeprecationWarning, match="edge_shares is called edge_parameters") as said:
        assert replace(rich, edge_shares=None).edge_parameters is None
    with pytest.warns(DeprecationWarning) as said:
        made = SurfaceMesh(
            points=rich.points,
            triangles=rich.triangles,
            uv_points=rich.uv_points,
            uv_triangles=rich.uv_triangles,
            inverse_sizes=rich.metric_root_3d,
        )
    assert said[0].filename == __file__
    assert made.metric_root_3d is rich.metric_root_3d
    with pytest.raises(TypeError, match="give metric_root_3d alone"), pytest.warns():
        rich.replaced(inverse_sizes=None, metric_root_3d=None)


@pytest.mark.parametrize("ratio", [1.0, 8.0])
@pytest.mark.parametrize("order", [1, 2])
def test_a_part_keeps_all_that_belongs_to_it(ratio, order):
    tube = sm.from_cadquery(cq.Workplane().circle(5).circle(4).extrude(4))
    mesh = sm.mesh(tube, sm.Sizing(chord=0.2, anisotropy=ratio), order=order)
    kept = mesh.face_ids <= 1
    part = mesh.submesh(kept)
    assert part.broken_invariant() is None and len(part.triangles) == kept.sum()
    assert np.array_equal(part.points[part.triangles], mesh.points[mesh.triangles[kept]])
    assert np.array_equal(part.uv, mesh.uv[kept])
    assert np.array_equal(part.sizes[part.triangles], mesh.sizes[mesh.triangles[kept]])
    assert np.array_equal(part.solid_ids, mesh.solid_ids[kept])
    if ratio > 1:
        w = mesh.metric_root_3d[mesh.uv_triangles[kept]]
        assert np.array_equal(part.metric_root_3d[part.uv_triangles], w)
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
    assert mesh.order == order and mesh.broken_invariant() is None
    assert (mesh.metric_root_3d is not None) == (ratio > 1)
