"""SurfaceMesh: immutable, compact, convertible; its invariants."""

import pickle

import numpy as np
import pytest
from handmade_meshes import Saddle, changed, grid

from surfmesh.result.connectivity import connect
from surfmesh.result.surface_mesh import SurfaceMesh


def slow_connectivity(triangles):
    """Edges -> half-edges in order: the obvious twin of ``connect``."""
    found = {}
    for t, corners in enumerate(triangles):
        for i in range(3):
            a, b = int(corners[i]), int(corners[(i + 1) % 3])
            found.setdefault((min(a, b), max(a, b)), []).append(3 * t + i)
    return found


@pytest.mark.parametrize("seed", range(5))
def test_connectivity_agrees_with_its_slow_twin(seed):
    triangles = np.random.default_rng(seed).integers(0, 9, (25, 3)).astype(np.int32)
    table, slow = connect(triangles), slow_connectivity(triangles)
    assert len(table.edges) == len(slow)
    for edge, halves, uses in zip(table.edges.tolist(), table.half_edges, table.uses):
        expected = slow[tuple(edge)]
        assert uses == len(expected)
        assert halves[halves >= 0].tolist() == expected[:2]  # the lower first


def test_connectivity_of_numbers_that_are_none():
    """A broken mesh can be held and examined, whatever its numbers."""
    high = 2**31 - 1
    for corners in ((-5, 3, 2), (0, high, 1), (-high - 1, high, 0), (4, 4, 4)):
        (a, b, c), table = corners, connect(np.array([corners], np.int32))
        ends = {(min(pair), max(pair)) for pair in ((a, b), (b, c), (c, a))}
        assert list(map(tuple, table.edges.tolist())) == sorted(ends)
        assert table.uses.sum() == 3


def test_no_triangles():
    mesh = SurfaceMesh(points=np.empty((0, 3)), triangles=np.empty((0, 3)))
    assert mesh.edges.shape == (0, 2)
    assert mesh.broken_invariant() is None


def test_arrays_are_read_only_and_typed(saddle):
    for name in ("points", "triangles", "uv_points", "uv_triangles", "face_ids", "sizes"):
        assert not getattr(saddle, name).flags.writeable
    assert saddle.triangles.dtype == saddle.face_ids.dtype == np.int32
    with pytest.raises(AttributeError):
        saddle.points = saddle.points


def test_uv_expands_and_is_the_image_of_the_corners(saddle):
    assert saddle.uv.shape == (128, 3, 2)
    image = Saddle().evaluate(saddle.uv.reshape(-1, 2))[0]
    np.testing.assert_array_equal(image.reshape(-1, 3, 3), saddle.points[saddle.triangles])


def test_pickle_keeps_everything_but_the_cache(saddle):
    edges = saddle.edges
    twin = pickle.loads(pickle.dumps(saddle))
    np.testing.assert_array_equal(twin.edges, edges)
    assert not twin.points.flags.writeable
    assert "connectivity" not in saddle.__getstate__()


def test_shapes_must_agree():
    with pytest.raises(ValueError, match=r"sizes has shape \(2,\), expected \(3,\)"):
        SurfaceMesh(points=np.eye(3), triangles=[(0, 1, 2)], sizes=[1, 2])


@pytest.mark.parametrize(
    ("change", "said"),
    [
        ({"triangles": [(0, 1, 9)]}, "triangles[0] = [0, 1, 9] is outside 0..2"),
        ({"triangles": [(0, 1, 1)]}, "triangle 0 = [0, 1, 1] repeats a corner"),
        ({"triangles": [(0, 1, 2), (2, 0, 1)]}, "triangles 0 and 1 have the same corners"),
        ({"points": [(0, 0, 0), (1, 0, 0), (0, np.nan, 0)]}, "points[2] = [0.0, nan, 0.0] is not"),
        ({"points": np.eye(4, 3)}, "vertex 3 belongs to no triangle"),
        ({"sizes": [1, 0, 1]}, "sizes[1] = 0.0 is not positive"),
        ({"face_ids": [1], "surfaces": (Saddle(),)}, "face_ids run from 1 to 1, surfaces are 1"),
    ],
)
def test_check_names_the_first_broken_invariant(change, said):
    mesh = SurfaceMesh(**({"points": np.eye(3), "triangles": [(0, 1, 2)]} | change))
    assert mesh.broken_invariant().startswith(said)


def test_sound_meshes_pass(saddle, tetrahedron, moebius_band):
    for mesh in (saddle, tetrahedron, moebius_band):
        assert mesh.broken_invariant() is None


def test_conversions_merge_nothing(saddle):
    doubled = changed(  # two vertices in one place stay two
        saddle,
        points=np.vstack((saddle.points, saddle.points)),
        triangles=np.vstack((saddle.triangles, saddle.triangles + 81)),
        uv_triangles=np.vstack((saddle.uv_triangles, saddle.uv_triangles)),
        face_ids=np.tile(saddle.face_ids, 2),
        sizes=np.tile(saddle.sizes, 2),
    )
    assert doubled.to_trimesh().vertices.shape == (162, 3)
    data = doubled.to_pyvista()
    assert data.n_points == 162 and data.n_cells == 256
    np.testing.assert_array_equal(data.cell_data["face_id"], doubled.face_ids)
    data.points[0] = 7.0
    assert doubled.points[0, 0] != 7.0


def test_to_meshio(saddle):
    pytest.importorskip("meshio")
    found = saddle.to_meshio()
    np.testing.assert_array_equal(found.cells_dict["triangle"], saddle.triangles)
    assert set(found.cell_data) == {"face_id", "alpha"}


def test_repr_and_notebook_table():
    mesh = grid(Saddle(), 2, warnings=["a < b"])
    assert repr(mesh) == "SurfaceMesh(9 points, 8 triangles, 1 face)"
    assert "saddle" in mesh._repr_html_() and "a &lt; b" in mesh._repr_html_()


def test_every_public_attribute_says_what_it_is():
    own = {name for name in dir(SurfaceMesh) if not name.startswith("_")}
    shown = [getattr(SurfaceMesh, name) for name in sorted(own - {"inverse_sizes", "edge_shares"})]
    assert all(getattr(item, "__doc__", None) or item is None for item in shown)
    for name in ("points", "triangles", "sizes", "mid_points", "one_sided"):
        assert f"{name}: " in SurfaceMesh.__doc__
    assert "face that each triangle lies on" in SurfaceMesh.face_ids.__doc__
    assert SurfaceMesh.face_ids.fset is None
