"""Files: what is written is read back; nothing is left behind when it fails."""

import struct

import numpy as np
import pytest
from handmade_meshes import Saddle, changed, grid

import surfmesh as sm
from surfmesh.errors import FileFormatError
from surfmesh.io import FORMATS, read, save

EXACT = (".vtu", ".vtp", ".obj", ".ply", ".msh", ".xdmf", ".off", ".med", ".3mf")
WITH_SIZES = (".vtu", ".vtp", ".ply", ".msh", ".xdmf")


@pytest.mark.parametrize("extension", FORMATS)
def test_round_trip(extension, saddle, tmp_path):
    path = tmp_path / f"mesh{extension}"
    assert saddle.save(path) == path
    found = read(path)
    if extension in EXACT:
        np.testing.assert_array_equal(found.points, saddle.points)
        np.testing.assert_array_equal(found.triangles, saddle.triangles)
        np.testing.assert_array_equal(found.face_ids, saddle.face_ids)
    else:
        np.testing.assert_allclose(
            found.points[found.triangles], saddle.points[saddle.triangles], atol=1e-7
        )
        assert len(found.points) == len(saddle.points)
        assert len(found.edges) == len(saddle.edges)
    if extension in WITH_SIZES:
        np.testing.assert_array_equal(found.sizes, saddle.sizes)
    if extension in (".vtu", ".vtp"):
        np.testing.assert_array_equal(found.uv, saddle.uv)
    assert [entry.name for entry in tmp_path.iterdir()] == [path.name]


def test_one_sidedness_survives_in_vtk_files(moebius_band, tmp_path):
    saved = changed(moebius_band, one_sided=True).save(tmp_path / "band.vtu")
    assert read(saved).one_sided


def test_numbers_keep_their_last_bit(tmp_path):
    points = np.random.default_rng(3).normal(size=(3, 3)) * (1e-9, 1, 1e9) + 1 / 3
    mesh = changed(grid(Saddle(), 1), points=np.vstack((points, points[:1] + 1)))
    for extension in EXACT:
        found = read(mesh.save(tmp_path / f"mesh{extension}"))
        np.testing.assert_array_equal(found.points, mesh.points)


def test_triangles_that_single_precision_flattens_are_named(tmp_path):
    mesh = grid(Saddle(), 2)
    points = mesh.points.copy()
    points[1] = points[0] + (1e-12, 1e-12, 0)
    found = read(changed(mesh, points=points).save(tmp_path / "mesh.stl"))
    assert found.broken_invariant() is None
    assert found.warnings == ("1 triangles without area in single precision left out",)


def test_gmsh_reads_msh_with_a_surface_for_each_face_and_a_group_for_each_name(saddle, tmp_path):
    gmsh = pytest.importorskip("gmsh")
    path = saddle.save(tmp_path / "mesh.msh")
    gmsh.initialize(interruptible=False)
    try:
        gmsh.option.setNumber("General.Terminal", 0)
        gmsh.open(str(path))
        groups = gmsh.model.getPhysicalGroups()
        assert groups == [(2, 1)] and gmsh.model.getPhysicalName(2, 1) == "saddle"
        assert gmsh.model.getEntitiesForPhysicalGroup(2, 1).tolist() == [1, 2]
        tags, coordinates, _ = gmsh.model.mesh.getNodes()
        ordered = coordinates.reshape(-1, 3)[np.argsort(tags)]
        np.testing.assert_array_equal(ordered, saddle.points)
        _, tags, nodes = gmsh.model.mesh.getElements(2)
        corners = nodes[0].reshape(-1, 3)[np.argsort(tags[0])].astype(int) - 1
        np.testing.assert_array_equal(corners, saddle.triangles)
    finally:
        gmsh.finalize()


def test_meshio_reads_msh_and_vtu(saddle, tmp_path):
    meshio = pytest.importorskip("meshio")
    for name in ("mesh.msh", "mesh.vtu"):
        found = meshio.read(saddle.save(tmp_path / name))
        corners = found.points[np.vstack([block.data for block in found.cells])]
        np.testing.assert_array_equal(corners, saddle.points[saddle.triangles])


def test_obj_of_other_programs(tmp_path):
    path = tmp_path / "other.obj"
    path.write_text(
        "# by hand\nv 0 0 0\nv 1 0 0\nv 0 1 0\nvn 0 0 1\n\nf 1//1 2//1 3//1\nf -1 -2 -3\n"
    )
    assert read(path).triangles.tolist() == [[0, 1, 2], [2, 1, 0]]


@pytest.mark.parametrize(
    ("name", "said"),
    [
        ("mesh.h5m", "mesh.save_dagmc(path, materials)"),
        ("mesh.foo", "extension '.foo' is not known; known are .vtu .vtp"),
        ("mesh", "has no extension"),
        ("nowhere/mesh.vtu", "does not exist"),
        ("file/mesh.vtu", "does not exist"),
        ("folder.stl", "is a folder"),
    ],
)
def test_places_that_cannot_be_written(name, said, saddle, tmp_path):
    (tmp_path / "file").write_text("")
    (tmp_path / "folder.stl").mkdir()
    before = sorted(tmp_path.iterdir())
    with pytest.raises(FileFormatError) as caught:
        save(saddle, tmp_path / name)
    assert said in str(caught.value) and "\n" not in str(caught.value)
    assert sorted(tmp_path.iterdir()) == before


@pytest.mark.parametrize("extension", FORMATS)
def test_a_failed_write_leaves_the_old_file(extension, saddle, tmp_path, monkeypatch):
    from importlib import import_module

    path = tmp_path / f"mesh{extension}"
    path.write_text("old")

    def fail(mesh, temporary):
        temporary.write_text("half")
        raise OSError(28, "No space left on device")

    monkeypatch.setattr(import_module(FORMATS[extension]), "write", fail)
    with pytest.raises(FileFormatError, match="No space left on device"):
        save(saddle, path)
    assert path.read_text() == "old"
    assert len(list(tmp_path.iterdir())) == 1


@pytest.mark.parametrize("extension", FORMATS)
@pytest.mark.parametrize("length", [0, 40, 0.5, 0.97])
def test_damaged_files_are_refused_in_one_line(extension, length, saddle, tmp_path, capfd):
    path = saddle.save(tmp_path / f"mesh{extension}")
    whole = path.read_bytes()
    path.write_bytes(whole[: int(length * len(whole)) if isinstance(length, float) else length])
    with pytest.raises(FileFormatError) as caught:  # without an end mark: by the record of groups
        read(path)
    assert str(path) in str(caught.value) and "\n" not in str(caught.value)
    assert capfd.readouterr() == ("", "")


@pytest.mark.parametrize("extension", FORMATS)
def test_rubbish_is_refused(extension, tmp_path, capfd):
    path = tmp_path / f"mesh{extension}"
    path.write_bytes(np.random.default_rng(0).bytes(3000))
    with pytest.raises(FileFormatError):
        read(path)
    assert capfd.readouterr() == ("", "")


def test_other_cells_than_triangles_are_refused(tmp_path):
    path = tmp_path / "quad.obj"
    path.write_text("v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nf 1 2 3 4\n")
    with pytest.raises(FileFormatError, match="line 5 is not a triangle"):
        read(path)


def test_indices_out_of_range_are_refused(tmp_path):
    path = tmp_path / "mesh.obj"
    path.write_text("v 0 0 0\nv 1 0 0\nv 1 1 0\nf 1 2 9\n")
    with pytest.raises(FileFormatError, match=r"triangles\[0\] = \[0, 1, 8\] is outside 0..2"):
        read(path)


def test_missing_file_and_empty_mesh(saddle, tmp_path):
    with pytest.raises(FileFormatError, match="no such file"):
        read(tmp_path / "none.vtu")
    empty = changed(saddle, triangles=np.empty((0, 3)), uv_triangles=np.empty((0, 3)), face_ids=[])
    with pytest.raises(FileFormatError, match="no triangles"):
        save(empty, tmp_path / "empty.vtu")


def test_stl_is_binary_and_counts_its_triangles(saddle, tmp_path):
    content = saddle.save(tmp_path / "mesh.stl").read_bytes()
    assert struct.unpack_from("<I", content, 80) == (128,)
    assert len(content) == 84 + 50 * 128


@pytest.mark.parametrize("suffix, order", [(".vtu", 1), (".vtp", 1), (".vtu", 2)])
def test_sizes_with_a_direction_travel(tmp_path, suffix, order):
    torus = sm.load("torus")
    mesh = sm.mesh(torus, sm.Sizing(chord=0.02, anisotropy=4), order=order)
    there = read(mesh.save(tmp_path / f"torus{suffix}"))
    assert np.array_equal(there.metric_root_3d, mesh.metric_root_3d)
    assert np.array_equal(there.uv, mesh.uv) and there.broken_invariant() is None
    for name in ("alpha_metric_mean", "alpha_metric_min", "quasi_unit_share", "length_std"):
        assert getattr(sm.check(there), name) == pytest.approx(getattr(sm.check(mesh), name))


def test_part_of_a_file_keeps_its_metric(tmp_path):
    import pyvista

    mesh = sm.mesh(sm.load("torus"), sm.Sizing(chord=0.02, anisotropy=4))
    path = tmp_path / "torus.vtu"
    mesh.save(path)
    part = pyvista.read(path).extract_cells(range(100))
    part.save(path)
    assert read(path).metric_root_3d.shape == mesh.metric_root_3d.shape
    part.clear_field_data()
    part.save(path)
    assert read(path).metric_root_3d is None and read(path).uv is not None


def test_only_two_solids_share_a_triangle_of_an_ascii_stl(tmp_path):
    """One that comes again within a solid is a fault of it, and no side of another."""
    facet = "facet normal 0 0 1\nouter loop\n{}endloop\nendfacet\n"
    corners = ["vertex 0 0 0\n", "vertex 1 0 0\n", "vertex 0 1 0\n"]
    ahead, back = facet.format("".join(corners)), facet.format("".join(corners[::-1]))
    path = tmp_path / "twice.stl"
    for again in (ahead, back):
        path.write_text(f"solid a\n{ahead}{again}endsolid a\n")
        assert "have the same corners" in sm.check(path).problems[0]
    path.write_text(f"solid a\n{ahead}endsolid a\nsolid b\n{back}endsolid b\n")
    assert read(path).solid_ids.tolist() == [[0, 1]]
    path.write_text(f"solid a\n{ahead}endsolid a\nsolid b\n{ahead}endsolid b\n")
    assert read(path).solid_ids.tolist() == [[0, -1], [1, -1]]


def test_nastran_elements_without_a_property_are_one_face(tmp_path):
    grid = "".join(f"GRID,{k + 1},,{k % 2}.,{k // 2}.,0.\n" for k in range(4))
    path = tmp_path / "bare.bdf"
    path.write_text(f"BEGIN BULK\n{grid}CTRIA3,1,,1,2,3\nCTRIA3,2,,2,4,3\nENDDATA\n")
    assert read(path).face_ids.tolist() == [0, 0]


def test_rigid_triangles_of_abaqus_are_triangles(tmp_path):
    path = tmp_path / "rigid.inp"
    path.write_text("*NODE\n1,0.,0.,0.\n2,1.,0.,0.\n3,0.,1.,0.\n*ELEMENT, TYPE=R3D3\n1,1,2,3\n")
    assert read(path).triangles.tolist() == [[0, 1, 2]]


def test_su2_without_elements_says_so(tmp_path):
    path = tmp_path / "none.su2"
    path.write_text("NDIME= 3\nNELEM= 0\nNPOIN= 0\n")
    with pytest.raises(FileFormatError, match="there are no triangles in it"):
        read(path)


def test_med_families_without_groups_are_read(saddle, tmp_path):
    h5py = pytest.importorskip("h5py")
    path = saddle.save(tmp_path / "bare.med")
    with h5py.File(path, "r+") as file:
        del file["surfmesh_groups"]
        (mesh,) = file["FAS"]
        for family in file["FAS"][mesh]["ELEME"].values():
            del family["GRO"]
    assert np.array_equal(read(path).triangles, saddle.triangles)
