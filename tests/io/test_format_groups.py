"""Groups in files: faces, names, colours, kinds, solids, unit, edges; nodes of order 2."""

import dataclasses
import os
import pickle
import shutil
import subprocess
from pathlib import Path

import cadquery as cq
import numpy as np
import pytest
from handmade_meshes import Saddle, grid
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

import surfmesh as sm
from surfmesh.errors import FileFormatError
from surfmesh.io import FORMATS, read
from surfmesh.io.bdf import real
from surfmesh.io.group_record import MARK, group_fields, group_lines, unique_labels
from surfmesh.io.text_columns import shortest
from surfmesh.result.mesh_groups import MeshGroups

FULL = [extension for extension in FORMATS if extension != ".stl"]
WITH_EDGES = [extension for extension in FULL if extension not in (".glb", ".3mf")]
WITH_ORDER_2 = [".vtu", ".msh", ".inp", ".bdf", ".xdmf", ".med"]
DIGITS = {".glb": 2e-7}  # of the size; 1e-12 elsewhere


@pytest.fixture(scope="module")
def boxes():
    """Two boxes that share a face, and a loose disc; names that files have trouble with."""
    from OCP.BOPAlgo import BOPAlgo_Builder

    fuse = BOPAlgo_Builder()
    fuse.AddArgument(cq.Solid.makeBox(1, 1, 1).wrapped)
    fuse.AddArgument(cq.Solid.makeBox(2, 1, 1, cq.Vector(1, 0, 0)).wrapped)
    fuse.Perform()
    disc = cq.Face.makeFromWires(cq.Wire.makeCircle(1 / 3, cq.Vector(0, 0, 4), cq.Vector(0, 0, 1)))
    shape = cq.Compound.makeCompound([cq.Shape.cast(fuse.Shape()), disc])
    mesh = sm.mesh(sm.from_cadquery(shape), 0.4)
    assert len(mesh.groups.face_kinds) == 12
    names = ['Deckel <oben> & "unten"', "überall", "top", "top", " ", "a" * 100, *[""] * 6]
    colours = [(1.0, 0.0, 0.0), None, (0.1, 0.2, 0.3), *[None] * 9]
    groups = dataclasses.replace(
        mesh.groups,
        face_names=tuple(names),
        face_colours=tuple(colours),
        solid_names=("left part", "right,part"),
        solid_colours=((0.0, 0.0, 1.0), None),
        edge_names=("rim", "top"),
        unit="in",
    )
    return dataclasses.replace(mesh, groups=groups)


def segments(mesh):
    return {(edge, *ends) for edge, ends in zip(mesh.edge_ids.tolist(), mesh.edge_segments.tolist())
            for ends in [tuple(sorted(ends))]}  # fmt: skip


@pytest.mark.parametrize("extension", FULL)
def test_groups_come_back(extension, boxes, tmp_path):
    found = read(boxes.save(tmp_path / f"boxes{extension}"))
    assert found.groups == boxes.groups
    np.testing.assert_array_equal(found.face_ids, boxes.face_ids)
    np.testing.assert_array_equal(found.solid_ids, boxes.solid_ids)
    np.testing.assert_array_equal(found.triangles, boxes.triangles)
    atol = DIGITS.get(extension, 1e-12)
    np.testing.assert_allclose(found.points, boxes.points, rtol=0, atol=4 * atol)
    if extension in WITH_EDGES:
        assert segments(found) == segments(boxes)
        np.testing.assert_array_equal(found.vertex_ids, boxes.vertex_ids)


@pytest.mark.parametrize("extension", WITH_ORDER_2)
def test_nodes_of_order_2_come_back(extension, boxes, tmp_path):
    middles = boxes.points[boxes.edges].mean(axis=1) + 0.01
    curved = dataclasses.replace(boxes, mid_points=middles)
    found = read(curved.save(tmp_path / f"boxes{extension}"))
    assert found.order == 2 and found.groups == boxes.groups
    np.testing.assert_array_equal(found.elements, curved.elements)
    np.testing.assert_allclose(found.nodes, curved.nodes, rtol=0, atol=4e-12)
    assert segments(found) == segments(boxes)


def test_formats_without_nodes_amid_edges_say_so(boxes, tmp_path):
    curved = dataclasses.replace(boxes, mid_points=boxes.points[boxes.edges].mean(axis=1))
    with pytest.warns(UserWarning, match=r"\.ply holds the corners alone; for order 2 use \.vtu"):
        found = read(curved.save(tmp_path / "boxes.ply"))
    np.testing.assert_array_equal(found.triangles, boxes.triangles)


def test_six_nodes_are_corners_and_then_the_middles_of_their_edges(boxes):
    middles = boxes.points[boxes.edges].mean(axis=1)
    curved = dataclasses.replace(boxes, mid_points=middles)
    corners = curved.nodes[curved.elements]
    for middle, (a, b) in zip((3, 4, 5), ((0, 1), (1, 2), (2, 0))):
        expected = (corners[:, a] + corners[:, b]) / 2
        np.testing.assert_allclose(corners[:, middle], expected, atol=1e-15)


def test_ascii_stl_has_a_body_for_each_solid_and_the_shared_face_in_both(boxes, tmp_path):
    path = boxes.save(tmp_path / "boxes.stl", ascii=True)
    text = path.read_text()
    named = [line[6:] for line in text.splitlines() if line.startswith("solid ")]
    assert named == ["surface", "left part", "right,part"]
    shared = int((boxes.solid_ids >= 0).all(axis=1).sum())
    assert shared and text.count("endfacet") == len(boxes.triangles) + shared
    found = read(path)
    assert len(found.triangles) == len(boxes.triangles)
    assert len(found.points) == len(boxes.points)
    assert int((found.solid_ids >= 0).all(axis=1).sum()) == shared
    trimesh = pytest.importorskip("trimesh")
    volumes = [body.volume for body in trimesh.load(path).geometry.values() if body.is_watertight]
    np.testing.assert_allclose(sorted(volumes), [1, 2], rtol=1e-9)


def test_only_stl_has_an_ascii_form(boxes, tmp_path):
    with pytest.raises(FileFormatError, match=r"only \.stl has an ASCII form"):
        boxes.save(tmp_path / "boxes.ply", ascii=True)


def test_glb_has_a_node_for_each_solid_in_metres(boxes, tmp_path):
    trimesh = pytest.importorskip("trimesh")
    scene = trimesh.load(boxes.save(tmp_path / "boxes.glb"))
    assert {"left part", "right,part", "faces of no solid"} <= set(scene.graph.nodes)
    np.testing.assert_allclose(scene.extents, np.ptp(boxes.points, axis=0) * 0.0254, rtol=1e-6)
    painted = [getattr(body.visual, "material", None) for body in scene.geometry.values()]
    reds = {tuple(material.baseColorFactor[:3]) for material in painted if material is not None}
    assert (255, 0, 0) in reds and (0, 0, 255) in reds


def test_glb_far_from_the_origin_keeps_its_digits(boxes, tmp_path):
    trimesh = pytest.importorskip("trimesh")
    moved = dataclasses.replace(boxes, points=boxes.points + (1e6, 0, -1e6))
    path = moved.save(tmp_path / "far.glb")
    np.testing.assert_allclose(read(path).points, moved.points, rtol=0, atol=1e-6)
    bounds = np.stack((moved.points.min(axis=0), moved.points.max(axis=0)))
    np.testing.assert_allclose(trimesh.load(path).bounds, bounds * 0.0254, rtol=0, atol=1e-6)


def test_3mf_is_read_by_trimesh_as_closed_solids_in_inches(boxes, tmp_path):
    trimesh = pytest.importorskip("trimesh")
    pytest.importorskip("lxml")
    scene = trimesh.load(boxes.save(tmp_path / "boxes.3mf"))
    closed = {name: body.volume for name, body in scene.geometry.items() if body.is_watertight}
    assert closed == pytest.approx({"left part": 1.0, "right,part": 2.0})
    assert {body.units for body in scene.geometry.values()} == {"inch"}


def test_gmsh_knows_surfaces_volumes_and_names(boxes, tmp_path):
    gmsh = pytest.importorskip("gmsh")
    gmsh.initialize(interruptible=False)
    try:
        gmsh.option.setNumber("General.Terminal", 0)
        gmsh.open(str(boxes.save(tmp_path / "boxes.msh")))
        model = gmsh.model
        names = [model.getPhysicalName(*group) for group in model.getPhysicalGroups(2)]
        assert "top" in names and len(names) == len(set(names)) == 11
        assert model.getEntitiesForPhysicalGroup(2, 1 + names.index("top")).tolist() == [3, 4]
        # those who know names alone must not take the edge for the face
        assert model.getPhysicalName(1, 2) == "top (edge)"
        assert [model.getPhysicalName(3, tag) for tag in (1, 2)] == ["left part", "right,part"]
        sides = [{abs(tag) for _, tag in model.getBoundary([(3, solid)])} for solid in (1, 2)]
        assert [len(side) for side in sides] == [6, 6] and len(sides[0] & sides[1]) == 1
        tags = [model.mesh.getElements(2, face)[1][0] for face in range(1, 13)]
        assert sum(map(len, tags)) == len(boxes.triangles)
        again = tmp_path / "again.msh"
        gmsh.option.setNumber("Mesh.Binary", 1)
        gmsh.write(str(again))
    finally:
        gmsh.finalize()
    found = read(again)
    assert found.groups == boxes.groups
    np.testing.assert_array_equal(found.face_ids, boxes.face_ids)
    np.testing.assert_array_equal(found.points, boxes.points)


@pytest.mark.parametrize("order", [1, 2])
def test_files_that_gmsh_makes_of_its_own_are_read(order, tmp_path):
    gmsh = pytest.importorskip("gmsh")
    gmsh.initialize(interruptible=False)
    try:
        gmsh.option.setNumber("General.Terminal", 0)
        gmsh.model.occ.addBox(0, 0, 0, 1, 1, 1)
        gmsh.model.occ.synchronize()
        gmsh.model.addPhysicalGroup(2, [1, 2], 5, "sides")
        for option in ("Binary", "SaveAll", "BdfFieldFormat"):
            gmsh.option.setNumber(f"Mesh.{option}", 1)
        gmsh.model.mesh.generate(2)
        gmsh.model.mesh.setOrder(order)
        for extension in (".msh", ".inp", ".bdf"):
            gmsh.write(str(tmp_path / f"box{extension}"))
            found = read(tmp_path / f"box{extension}")
            assert found.broken_invariant() is None and found.order == order
            assert np.unique(found.face_ids).tolist() == list(range(6))
        names = read(tmp_path / "box.msh").groups.face_names
        assert names == ("sides", "sides", "", "", "", "")
    finally:
        gmsh.finalize()


def test_a_med_file_without_a_record_has_families_for_faces(boxes, tmp_path):
    h5py = pytest.importorskip("h5py")
    path = boxes.save(tmp_path / "boxes.med")
    with h5py.File(path, "r+") as file:
        del file["surfmesh_groups"]
    found = read(path)
    np.testing.assert_array_equal(found.face_ids, boxes.face_ids)
    assert found.groups.face_names[2:4] == ("top", "top")


def test_dolfinx_finds_each_triangle_in_one_group_and_nodes_without_gaps(boxes, tmp_path):
    """What its reader of .msh demands of the Gmsh model (dolfinx/io/gmsh.py)."""
    gmsh = pytest.importorskip("gmsh")
    gmsh.initialize(interruptible=False)
    try:
        gmsh.option.setNumber("General.Terminal", 0)
        gmsh.open(str(boxes.save(tmp_path / "boxes.msh")))
        tagged = []
        for dimension, tag in gmsh.model.getPhysicalGroups():
            for entity in gmsh.model.getEntitiesForPhysicalGroup(dimension, tag):
                kinds, tags, _ = gmsh.model.mesh.getElements(dimension, entity)
                assert len(kinds) == 1
                tagged += tags[0].tolist() if dimension == 2 else []
        assert sorted(tagged) == list(range(1, len(boxes.triangles) + 1))
        nodes, _, _ = gmsh.model.mesh.getNodes()
        assert sorted(nodes.tolist()) == list(range(1, len(boxes.points) + 1))
    finally:
        gmsh.finalize()


@pytest.mark.parametrize("extension", [".stl", ".obj", ".ply", ".off", ".glb", ".3mf"])
def test_trimesh_finds_all_triangles(extension, boxes, tmp_path):
    trimesh = pytest.importorskip("trimesh")
    pytest.importorskip("lxml")
    path = boxes.save(tmp_path / f"boxes{extension}")
    found = trimesh.load(path, process=False, force="mesh")
    scale = 0.0254 if extension == ".glb" else 1.0
    both = int((boxes.solid_ids >= 0).all(axis=1).sum()) if extension in (".glb", ".3mf") else 0
    assert len(found.faces) == len(boxes.triangles) + both
    sides = boxes.points[boxes.triangles]
    normals = np.cross(sides[:, 1] - sides[:, 0], sides[:, 2] - sides[:, 0])
    lengths = np.linalg.norm(normals, axis=1) / 2
    area = lengths.sum() + (lengths[(boxes.solid_ids >= 0).all(axis=1)].sum() if both else 0)
    assert found.area == pytest.approx(area * scale**2, rel=1e-5)


@pytest.mark.parametrize("extension", [".vtu", ".vtp", ".stl", ".ply", ".obj"])
def test_pyvista_finds_all_triangles(extension, boxes, tmp_path):
    pyvista = pytest.importorskip("pyvista")
    found = pyvista.read(boxes.save(tmp_path / f"boxes{extension}"))
    assert found.n_cells == len(boxes.triangles) and found.n_points >= len(boxes.points)
    extent = np.ptp(boxes.points, axis=0)
    np.testing.assert_allclose(np.ptp(found.points, axis=0), extent, rtol=1e-6)


@pytest.mark.parametrize("extension", [".msh", ".bdf", ".med", ".stl"])
def test_gmsh_finds_all_triangles(extension, boxes, tmp_path):
    gmsh = pytest.importorskip("gmsh")
    gmsh.initialize(interruptible=False)
    try:
        gmsh.option.setNumber("General.Terminal", 0)
        gmsh.open(str(boxes.save(tmp_path / f"boxes{extension}")))
        _, tags, _ = gmsh.model.mesh.getElements(2)
        assert sum(map(len, tags)) == len(boxes.triangles)
        if extension in (".bdf", ".med"):
            assert len(gmsh.model.getEntities(2)) == 12
    finally:
        gmsh.finalize()


@pytest.mark.parametrize("extension", [".vtu", ".msh", ".inp", ".bdf", ".xdmf", ".off", ".med"])
@pytest.mark.parametrize("order", [1, 2])
def test_meshio_reads_points_and_triangles(extension, order, boxes, tmp_path):
    meshio = pytest.importorskip("meshio")
    if order == 2:
        if extension not in WITH_ORDER_2:
            pytest.skip("corners alone")
        boxes = dataclasses.replace(boxes, mid_points=boxes.points[boxes.edges].mean(axis=1))
    found = meshio.read(boxes.save(tmp_path / f"boxes{extension}"))
    kind = {1: "triangle", 2: "triangle6"}[order]
    cells = np.vstack([block.data for block in found.cells if block.type == kind])
    expected = boxes.nodes[boxes.elements]
    np.testing.assert_allclose(found.points[cells], expected, rtol=0, atol=4e-12)


def test_meshio_finds_the_sets_of_inp(boxes, tmp_path):
    meshio = pytest.importorskip("meshio")
    found = meshio.read(boxes.save(tmp_path / "boxes.inp"))
    sizes = {name: sum(map(len, cells)) for name, cells in found.cell_sets.items()}
    assert sizes["top"] == int(np.isin(boxes.face_ids, (2, 3)).sum())
    assert sizes["left_part"] == int((boxes.solid_ids == 0).any(axis=1).sum())
    rim = np.unique(boxes.edge_segments[boxes.edge_ids == 0])
    assert sorted(found.point_sets["rim"].tolist()) == rim.tolist()


def test_other_libraries_get_solids_colours_and_nodes(boxes):
    curved = dataclasses.replace(boxes, mid_points=boxes.points[boxes.edges].mean(axis=1))
    data = curved.to_pyvista()
    np.testing.assert_array_equal(data.cell_data["solid_id"], boxes.solid_ids)
    first = np.flatnonzero(boxes.face_ids == 0)
    assert (data.cell_data["colour"][first] == (255, 0, 0)).all()
    assert (curved.to_trimesh().visual.face_colors[first] == (255, 0, 0, 255)).all()
    pytest.importorskip("meshio")
    found = curved.to_meshio()
    np.testing.assert_array_equal(found.cells_dict["triangle6"], curved.elements)
    np.testing.assert_array_equal(found.cell_data["solid_id"][0], boxes.solid_ids)


def test_vtk_reads_xdmf(boxes, tmp_path):
    from vtkmodules.vtkIOXdmf2 import vtkXdmfReader

    reader = vtkXdmfReader()
    reader.SetFileName(str(boxes.save(tmp_path / "boxes.xdmf")))
    reader.Update()
    found = reader.GetOutputDataObject(0)
    assert found.GetNumberOfPoints() == len(boxes.points)
    assert found.GetCellData().HasArray("face_id") and found.GetCellData().HasArray("colour")


@settings(max_examples=15, suppress_health_check=[HealthCheck.function_scoped_fixture])
@given(st.lists(st.text(max_size=12), min_size=4, max_size=4), st.text(max_size=90))
def test_any_name_comes_back(tetrahedron, tmp_path, names, solid):
    groups = MeshGroups(face_names=names, solid_names=(solid,), edge_names=names[1:], unit="m")
    mesh = dataclasses.replace(
        tetrahedron,
        face_ids=range(4),
        solid_ids=[(0, -1)] * 4,
        edge_segments=[(0, 1), (1, 2)],
        edge_ids=(0, 2),
        groups=groups,
    )
    for extension in FULL:
        assert read(mesh.save(tmp_path / f"any{extension}")).groups == groups, extension
    mesh.save(tmp_path / "any.stl", ascii=True)
    assert len(read(tmp_path / "any.stl").triangles) == 4


@pytest.mark.parametrize(
    "name",
    ["surfmesh-groups 1:{}", "$Endsurfmesh", "ends in \\", "]]>", "endsolid x", "*NODE", "ENDDATA"],
)
def test_names_that_look_like_parts_of_files(name, tetrahedron, tmp_path):
    """Each broke a reader once: ours, meshio's or trimesh's."""
    groups = MeshGroups(face_names=(name,), solid_names=(name,), edge_names=(name,))
    fields = {"solid_ids": [(0, -1)] * 4, "edge_segments": [(0, 1)], "edge_ids": (0,)}
    mesh = dataclasses.replace(tetrahedron, groups=groups, **fields)
    for extension in FULL:
        path = mesh.save(tmp_path / f"any{extension}")
        assert read(path).groups == groups, extension
        if extension in (".vtu", ".msh", ".inp", ".bdf", ".xdmf", ".off", ".med"):
            assert len(pytest.importorskip("meshio").read(path).points) == 4
    trimesh = pytest.importorskip("trimesh")
    assert len(trimesh.load(mesh.save(tmp_path / "any.stl", ascii=True), force="mesh").faces) == 4


def test_surfaces_name_the_groups_of_a_mesh_without_cad():
    mesh = grid(Saddle(), 1)
    assert mesh.groups == MeshGroups(face_names=("saddle",), face_kinds=("",))
    assert mesh.face_name(0) == "saddle" and mesh.face_name(7) == "face 7"
    assert pickle.loads(pickle.dumps(mesh)).groups == mesh.groups


def test_a_record_without_its_middle_is_refused(boxes):
    lines = group_lines(boxes)
    assert all(len(line) <= 80 and " " not in line.removeprefix(MARK) for line in lines)
    assert group_fields(lines, len(boxes.triangles))["groups"] == boxes.groups
    with pytest.raises(ValueError):
        group_fields(lines[:2] + lines[3:], len(boxes.triangles))


def test_labels_for_sets_are_unique_in_any_case():
    found = unique_labels(["top", "Top", "1 a", "", "ü"], 8)
    assert found == ["top", "Top_2", "_1_a", "__", "___2"]


@given(st.floats(-1e30, 1e30))
def test_numbers_in_columns_keep_their_digits(value):
    (text,) = shortest([value], 20)
    assert len(text) <= 20 and float(text) == pytest.approx(value, rel=1e-12, abs=1e-18)
    card = real(value)
    assert len(card) <= 16 and "." in card
    from surfmesh.io.bdf import _number

    assert _number(card) == pytest.approx(value, rel=2e-10, abs=1e-99)


def test_stl_with_a_body_for_each_name_of_a_face(boxes, tmp_path):
    trimesh = pytest.importorskip("trimesh")
    path = boxes.save(tmp_path / "boxes.stl", solids="faces")
    bodies = [line.split()[1] for line in path.read_text().splitlines() if line.startswith("solid")]
    assert len(bodies) == len(set(bodies)) == 11 and "top" in bodies  # two faces have one name
    assert len(trimesh.load(path, force="mesh").faces) == len(boxes.triangles)


def test_openfoam_finds_the_patches_of_a_solid(tmp_path):
    home = Path("/usr/share/openfoam")  # as Debian's package has it; nothing else sets the variable
    if shutil.which("surfaceCheck") is None:
        pytest.skip("surfaceCheck is not installed (Debian: openfoam)")
    part = cq.Workplane().box(1, 1, 1).faces(">Z").tag("lid").end()
    path = sm.mesh(part, 0.4).save(tmp_path / "box.stl", solids="faces")
    environment = os.environ | ({"WM_PROJECT_DIR": str(home)} if home.is_dir() else {})
    command = [shutil.which("surfaceCheck") or "", path.name]
    told = subprocess.run(
        command, capture_output=True, text=True, cwd=tmp_path, env=environment
    ).stdout
    assert "Surface has no illegal triangles" in told and "Surface is closed" in told
    assert "lid" in told and "face_4" in told


def test_second_order_by_target(boxes, tmp_path):
    curved = dataclasses.replace(boxes, mid_points=boxes.points[boxes.edges].mean(axis=1))
    for target, kind in (("", "STRI65"), ("abaqus", "STRI65"), ("calculix", "S6")):
        path = curved.save(tmp_path / "boxes.inp", target=target)
        assert f"TYPE={kind}," in path.read_text() and read(path).order == 2
    for extension, options in ((".vtu", {"target": "calculix"}), (".inp", {"solids": "faces"})):
        with pytest.raises(FileFormatError, match="alone"):
            boxes.save(tmp_path / f"boxes{extension}", **options)
    with pytest.raises(FileFormatError, match="'abaqus' or 'calculix', not 'ansys'"):
        boxes.save(tmp_path / "boxes.inp", target="ansys")


def test_names_of_faces_are_sets_and_surfaces_of_inp(boxes, tmp_path):
    text = boxes.save(tmp_path / "boxes.inp").read_text()
    assert text.count("*SURFACE, NAME=top, TYPE=ELEMENT\ntop, SPOS\n") == 1
    assert text.count("*NSET, NSET=top\n") == 1 and text.count("*NSET, NSET=top_2\n") == 1
    assert text.splitlines()[1].startswith("*NODE") and MARK in text.splitlines()[-1]


def test_a_file_without_its_last_comments_is_cut(boxes, tmp_path):
    for extension in (".inp", ".su2"):
        path = boxes.save(tmp_path / f"boxes{extension}")
        path.write_text("".join(row for row in path.open() if MARK not in row))
        with pytest.raises(FileFormatError, match="is cut"):
            read(path)


def test_a_planar_domain_has_two_dimensions_in_su2(tmp_path):
    curved = grid(Saddle(), 2)
    flat = np.where([True, True, False], curved.points, 0.0)
    mesh = dataclasses.replace(curved, points=flat)
    path = mesh.save(tmp_path / "flat.su2")
    assert "NDIME= 2" in path.read_text() and "MARKER_TAG= boundary" in path.read_text()
    found = read(path)
    np.testing.assert_array_equal(found.triangles, mesh.triangles)
    meshio = pytest.importorskip("meshio")
    assert meshio.read(path).points.shape == (9, 2)


def test_pynastran_finds_all_references(boxes, tmp_path):
    bdf = pytest.importorskip("pyNastran.bdf.bdf")
    model = bdf.read_bdf(boxes.save(tmp_path / "boxes.bdf"), xref=True, debug=None)
    assert len(model.elements) == len(boxes.triangles) and len(model.properties) == 12
    assert {element.pid_ref.mid1_ref.mid for element in model.elements.values()} == {1}


def test_names_are_seen_in_paraview_and_pyvista(boxes, tmp_path):
    pyvista = pytest.importorskip("pyvista")
    for extension in (".vtu", ".vtp"):
        found = pyvista.read(boxes.save(tmp_path / f"boxes{extension}"))
        assert found.field_data["face top"].tolist() == [2, 3]
        assert found.field_data["solid left part"].tolist() == [0]
        assert found.field_data["edge rim"].tolist() == [0]
    data = boxes.to_pyvista()
    assert list(data.field_data["face_names"])[2] == "top"
    assert list(data.field_data["solid_names"]) == ["left part", "right,part"]
