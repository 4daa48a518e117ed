"""A mesh in several files: the same mesh when it is read, the old one until all are there."""

import cadquery as cq
import numpy as np
import pytest

import surfmesh as sm
from surfmesh.errors import FileFormatError
from surfmesh.io import pvtu, read

ARRAYS = (
    "points", "triangles", "uv_points", "uv_triangles", "face_ids", "edge_segments", "edge_ids",
    "vertex_ids", "sizes", "solid_ids", "metric_root_3d", "mid_points", "promises",
)  # fmt: skip


@pytest.fixture(autouse=True)
def small_pieces(monkeypatch):
    monkeypatch.setattr(pvtu, "LARGEST", 150)


@pytest.fixture(scope="module")
def part():
    return cq.Workplane().box(2, 2, 1).faces(">Z").hole(0.8)


@pytest.fixture(scope="module")
def mesh(part):
    return sm.mesh(part, 0.2)


def require_same(found, expected):
    for name in ARRAYS:
        ours, theirs = getattr(found, name), getattr(expected, name)
        assert (ours is None) == (theirs is None), name
        if ours is not None:
            assert np.array_equal(ours, theirs, equal_nan=ours.dtype.kind == "f"), name
    assert found.groups == expected.groups and found.one_sided == expected.one_sided


def pieces_of(path):
    return sorted(path.with_name(f"{path.name}.pieces").iterdir())


@pytest.mark.parametrize("options", [{"size": 0.2}, {"chord": 0.01, "anisotropy": 3.0}])
@pytest.mark.parametrize("order", [1, 2])
def test_what_is_read_is_what_one_file_gives(part, options, order, tmp_path):
    made = sm.mesh(part, sm.Sizing(**options), order=order)
    path = made.save(tmp_path / "part.pvtu")
    assert len(pieces_of(path)) > 2
    require_same(read(path), read(made.save(tmp_path / "part.vtu")))


def test_each_piece_is_a_mesh_of_whole_faces(mesh, tmp_path):
    path = mesh.save(tmp_path / "part.pvtu")
    pieces = [read(piece) for piece in pieces_of(path)]
    faces = [set(piece.face_ids.tolist()) for piece in pieces]
    assert sum(map(len, faces)) == len(set.union(*faces))
    assert sum(len(piece.triangles) for piece in pieces) == len(mesh.triangles)
    assert all(piece.groups == mesh.groups for piece in pieces)


def test_pyvista_reads_it_and_knows_the_numbers(mesh, tmp_path):
    import pyvista

    found = pyvista.read(mesh.save(tmp_path / "part.pvtu"))
    assert found.n_cells == len(mesh.triangles)
    ids = np.asarray(found.point_data["GlobalPointIds"])
    assert np.array_equal(mesh.points[ids], found.points)
    assert found.GetPointData().GetGlobalIds() is not None


def test_points_of_no_triangle_and_one_face(saddle, tmp_path):
    lonely = sm.SurfaceMesh(points=np.vstack([saddle.points, np.ones(3)]),
                            triangles=saddle.triangles)  # fmt: skip
    require_same(read(lonely.save(tmp_path / "a.pvtu")), read(lonely.save(tmp_path / "a.vtu")))


def test_a_second_save_takes_the_first_away(mesh, part, tmp_path):
    path = mesh.save(tmp_path / "part.pvtu")
    first = pieces_of(path)
    index = path.read_bytes()
    assert mesh.save(path).read_bytes() == index and pieces_of(path) == first
    (first[0].parent / "notes.txt").write_text("mine")
    coarse = sm.mesh(part, 0.4)
    coarse.save(path)
    assert not set(first) & set(pieces_of(path))
    assert (first[0].parent / "notes.txt").exists()
    require_same(read(path), read(coarse.save(tmp_path / "coarse.vtu")))


@pytest.mark.parametrize("file", [0, 1, "index"])
def test_a_save_that_fails_leaves_the_old_mesh(mesh, part, file, tmp_path, monkeypatch):
    path = mesh.save(tmp_path / "part.pvtu")
    before = {place: place.read_bytes() for place in (path, *pieces_of(path))}
    count = 0

    def fail(*_):
        nonlocal count
        count += 1
        if count > (file if file != "index" else 0):
            raise OSError(28, "No space left on device")

    monkeypatch.setattr(pvtu, "write_index" if file == "index" else "write_grid", fail)
    with pytest.raises(FileFormatError, match="No space left on device"):
        sm.mesh(part, 0.3).save(path)
    assert {place: place.read_bytes() for place in (path, *pieces_of(path))} == before
    with pytest.raises(FileFormatError, match="No space left on device"):
        sm.mesh(part, 0.3).save(tmp_path / "new.pvtu")
    assert sorted(tmp_path.iterdir()) == [path, pieces_of(path)[0].parent]


@pytest.mark.parametrize(
    "source", ["/etc/passwd", "../other.vtu", "C:/x.vtu", "a\\..\\..\\x.vtu", "none.vtu", ""]
)
def test_pieces_elsewhere_are_not_read(mesh, source, tmp_path):
    path = mesh.save(tmp_path / "part.pvtu")
    text = path.read_text()
    first = f"part.pvtu.pieces/{pieces_of(path)[0].name}"
    path.write_text(text.replace(first, source))
    with pytest.raises(FileFormatError, match="piece"):
        read(path)


def test_pieces_that_do_not_fit_are_refused(mesh, part, tmp_path):
    path = mesh.save(tmp_path / "part.pvtu")
    first, second = pieces_of(path)[:2]
    whole = first.read_bytes()
    first.write_bytes(second.read_bytes())
    with pytest.raises(FileFormatError, match=r"missing|not one a triangle|numbers of points"):
        read(path)
    first.write_bytes(whole[: len(whole) // 2])
    with pytest.raises(FileFormatError):
        read(path)
    first.unlink()
    with pytest.raises(FileFormatError, match=r"no \.vtu file there"):
        read(path)


def test_pieces_of_other_meshes_differ_where_they_meet(mesh, tmp_path):
    path = mesh.save(tmp_path / "part.pvtu")
    other = mesh.replaced(points=mesh.points * 1.5).save(tmp_path / "other.pvtu")
    pieces_of(path)[0].write_bytes(pieces_of(other)[0].read_bytes())
    with pytest.raises(FileFormatError, match="shared points differ"):
        read(path)


def test_the_command_writes_and_checks_it(tmp_path, capsys):
    from surfmesh.cli import main

    path = tmp_path / "torus.pvtu"
    assert main(["mesh", "torus", "-o", str(path)]) == 0
    assert main(["check", str(path), "--surface", "torus"]) == 0
    assert "clean" in capsys.readouterr().out
