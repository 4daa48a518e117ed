"""Tetrahedra in the solids of a mesh: the surface stays, regions are right, files are taken."""

import shutil
import subprocess

import cadquery as cq
import numpy as np
import pytest

import surfmesh as sm
from surfmesh.errors import FileFormatError, MeshingError
from surfmesh.volume import ENGINES
from surfmesh.volume.by_ftetwild import LEFT_BEHIND
from surfmesh.volume.curved_tetrahedra import gradients, jacobians, least_jacobians
from surfmesh.volume.solid_regions import CORNERS as SIDES
from surfmesh.volume.solid_regions import sides_of_triangles, solids_of_tetrahedra
from surfmesh.volume.untangling import Untangled
from surfmesh.volume.untangling import _split_edges as edges_split
from surfmesh.volume.untangling import _split_in_four as in_four
from surfmesh.volume.volume_mesh import LEGS

PACKAGES = {"tetgen": "tetgen", "gmsh": "gmsh", "netgen": "netgen", "ftetwild": "pytetwild"}
CORNERS = np.array([(0, 0, 0), (1, 0, 0), (0, 1, 0), (0, 0, 1)], float)
STRAIGHT = np.vstack((CORNERS, CORNERS[LEGS].mean(axis=1)))


@pytest.fixture(scope="module")
def boxes():
    """Two boxes that share a face, the second with a cavity."""
    from OCP.BOPAlgo import BOPAlgo_Builder

    fuse = BOPAlgo_Builder()
    fuse.AddArgument(cq.Workplane().box(2, 2, 2).val().wrapped)
    hollow = cq.Workplane().box(2, 2, 2).cut(cq.Workplane().box(0.8, 0.8, 0.8))
    fuse.AddArgument(hollow.translate((2, 0, 0)).val().wrapped)
    fuse.Perform()
    return sm.mesh(sm.from_cadquery(cq.Shape.cast(fuse.Shape())), 0.8)


def fills(mesh, engine, **options):
    pytest.importorskip(PACKAGES[engine])
    return mesh.tetrahedralize(engine, **options)


@pytest.mark.parametrize("engine", ["tetgen", "gmsh", "netgen"])
@pytest.mark.parametrize("order", [1, 2])
def test_solids_are_filled_and_the_surface_stays(engine, order, boxes):
    found = fills(boxes, engine, order=order)
    assert found.order == order and found.elements.shape[1] == (4, 10)[order - 1]
    np.testing.assert_array_equal(found.nodes[: len(boxes.points)], boxes.points)
    own = [found.volumes[found.solid_ids == solid].sum() for solid in (0, 1)]
    assert sorted(own) == pytest.approx([8.0 - 0.8**3, 8.0], rel=1e-12)
    assert found.volumes.min() > 0.0 and not found.warnings
    at = found.face_sides
    assert (at[:, 0] >= 0).all()
    corners = found.tetrahedra[at[:, 0]]
    missing = (corners[:, :, None] != boxes.triangles[:, None, :]).all(axis=2)
    assert (missing.sum(axis=1) == 1).all()
    assert np.unique(found.elements).tolist() == list(range(len(found.nodes)))


def test_a_size_makes_smaller_tetrahedra(boxes):
    coarse, fine = (fills(boxes, "tetgen", size=size) for size in (None, 0.3))
    assert len(fine.elements) > 2 * len(coarse.elements)


def test_curved_middles_are_those_of_the_surface():
    mesh = sm.mesh(sm.load("torus"), 0.5, order=2)
    found = fills(mesh, "tetgen")
    np.testing.assert_array_equal(found.nodes[: len(mesh.nodes)], mesh.nodes)
    assert np.isin(mesh.elements, found.elements).all()


def drilled(chord):
    shape = cq.Workplane().box(6, 4, 3).edges("|Z").fillet(1).faces(">Z").workplane().hole(1.5)
    return sm.mesh(shape, sm.Sizing(chord=chord), order=2)


@pytest.mark.parametrize("engine", ["tetgen", "gmsh", "netgen"])
def test_curved_tetrahedra_are_turned_right_from_within(engine, monkeypatch):
    """Some of each engine are inside out as they come; the surface stays to the last bit."""
    mesh = drilled(0.2)
    with monkeypatch.context() as patch:
        patch.setattr("surfmesh.volume.untangling.ROUNDS", 0)
        given = fills(mesh, engine)
    turned = int((least_jacobians(given.nodes, given.elements) <= 0.0).sum())
    assert (f"{turned} curved tetrahedra" in "".join(given.warnings)) == (turned > 0)
    found = fills(mesh, engine)
    assert least_jacobians(found.nodes, found.elements).min() > 0.0 and not found.warnings
    np.testing.assert_array_equal(found.nodes[: len(mesh.nodes)], mesh.nodes)
    assert found.volume == pytest.approx(given.volume, rel=1e-12)
    assert (found.face_sides[:, 0] >= 0).all()


def test_a_split_tetrahedron_is_four_with_its_sides():
    nodes = STRAIGHT.copy()
    nodes[5] += (0.1, 0.1, -0.05)  # curved edges stay
    whole = np.arange(10)[None]
    solids = np.array([7], np.int32)
    found = in_four(Untangled(nodes, whole, solids, 1), np.array([True]))
    assert len(found.elements) == 4 and (found.solid_ids == 7).all()
    assert least_jacobians(found.nodes, found.elements).min() > 0.0
    np.testing.assert_array_equal(found.nodes[:10], nodes)
    assert jacobians(found.nodes[found.elements]).mean(axis=1).sum() == pytest.approx(
        jacobians(nodes[whole]).mean(), rel=1e-12
    )  # the mean of the coefficients is six times the volume
    behind, before = sides_of_triangles(found.elements[:, :4], np.array(SIDES))
    assert sorted((behind // 4).tolist()) == [0, 1, 2, 3] and (before == -1).all()


def test_the_tetrahedra_around_an_edge_are_two_each():
    """Two of them share the edge 0-1, whose middle 4 becomes a corner of four."""
    corners = np.array([(0, 0, 0), (0, 0, 2), (2, 0, 0), (0, 2, 0), (-2, 0, 0)], float)
    whole = np.array([(0, 1, 2, 3, 5, 6, 7, 8, 9, 10), (1, 0, 4, 3, 5, 11, 12, 9, 8, 13)])
    nodes = np.zeros((14, 3))
    nodes[:5] = corners
    for tetrahedron in whole:
        nodes[tetrahedron[4:]] = corners[tetrahedron[LEGS]].mean(axis=1)
    found = edges_split(Untangled(nodes, whole, np.array([7, 8], np.int32), 2), np.array([5]))
    assert sorted(found.solid_ids.tolist()) == [7, 7, 8, 8]
    assert len(found.nodes) == 14 + 5  # amid the edges to 0, 1, 2, 3 and 4, once each
    assert least_jacobians(found.nodes, found.elements) == pytest.approx(
        1.0
    )  # straight, well turned
    sizes = jacobians(found.nodes[found.elements]).mean(axis=1)
    assert sizes == pytest.approx(np.full(4, jacobians(nodes[whole]).mean() / 2.0))


@pytest.mark.parametrize("name, size", [("torus", 1.2), ("torus", 1.0), ("ellipsoid", 0.9)])
def test_no_coarse_curved_tetrahedron_is_left_inside_out(name, size):
    """Inner edges between corners of the surface left no room; 19, 34 and 1 were counted."""
    mesh = sm.mesh(name, size, order=2)
    found = fills(mesh, "tetgen")
    assert not found.warnings
    assert least_jacobians(found.nodes, found.elements).min() > 0.0 and found.volumes.min() > 0.0
    np.testing.assert_array_equal(found.nodes[: len(mesh.nodes)], mesh.nodes)
    legs, middles = found.elements[:, LEGS].reshape(-1, 2), found.elements[:, 4:].ravel()
    edges = np.column_stack((np.sort(legs, axis=1), middles))
    assert len(np.unique(edges, axis=0)) == len(np.unique(edges[:, :2], axis=0))  # one middle each


def test_slopes_of_jacobians_are_those_of_differences():
    random = np.random.default_rng(5)
    places = STRAIGHT[None] + 0.05 * random.normal(size=(3, 10, 3))
    weights = random.normal(size=(3, 20))
    step = random.normal(size=places.shape)
    ahead, behind = (
        (weights * jacobians(places + h * step)).sum() for h in (1e-5, -1e-5)
    )  # fmt: skip
    slope = (gradients(places, weights) * step).sum()
    assert slope == pytest.approx((ahead - behind) / 2e-5, rel=1e-8)


def test_ftetwild_leaves_nothing_behind(boxes, tmp_path, monkeypatch):
    pytetwild = pytest.importorskip("pytetwild")
    monkeypatch.chdir(tmp_path)

    def fails(*_, **__):
        (tmp_path / LEFT_BEHIND).write_text("solid")
        raise RuntimeError("no tetrahedra")

    monkeypatch.setattr(pytetwild, "tetrahedralize", fails)
    one = sm.mesh(sm.load("ellipsoid"), 0.8)
    with pytest.raises(MeshingError, match="fTetWild: no tetrahedra"):
        one.tetrahedralize("ftetwild")
    assert not list(tmp_path.iterdir())


def test_a_new_surface_is_said_to_be_new(boxes):
    pytest.importorskip("pytetwild")
    with pytest.raises(MeshingError, match="one solid"):
        boxes.tetrahedralize("ftetwild")


def test_what_encloses_nothing_and_words_that_are_not_known():
    open_mesh = sm.mesh(sm.load("catenoid"), 0.5)
    with pytest.raises(MeshingError, match="encloses nothing"):
        open_mesh.tetrahedralize()
    with pytest.raises(ValueError, match="engine must be one of tetgen, gmsh"):
        open_mesh.tetrahedralize("tetgne")
    with pytest.raises(ValueError, match="size"):
        open_mesh.tetrahedralize(size=0.0)
    with pytest.raises(ValueError, match="order"):
        open_mesh.tetrahedralize(order=3)


@pytest.mark.parametrize("engine", ENGINES)
def test_a_missing_engine_is_one_line(engine, boxes, monkeypatch):
    monkeypatch.setitem(__import__("sys").modules, PACKAGES[engine], None)
    if engine == "netgen":
        monkeypatch.setitem(__import__("sys").modules, "netgen.meshing", None)
    with pytest.raises(ImportError, match="pip install"):
        boxes.tetrahedralize(engine)


def test_triangles_find_the_tetrahedra_on_both_sides():
    tetrahedra = np.array([(0, 1, 2, 3), (0, 2, 1, 4)])
    behind, before = sides_of_triangles(tetrahedra, np.array([(1, 2, 0), (0, 2, 1), (1, 2, 3)]))
    assert (behind // 4).tolist() == [1, 0, 0] and (before[:2] // 4).tolist() == [0, 1]
    assert before[2] == -1


def test_two_solids_in_one_region_are_refused():
    triangles = np.array([(0, 2, 1), (0, 1, 3), (1, 2, 3), (2, 0, 3)])
    sides = np.array([(0, -1), (0, -1), (1, -1), (0, -1)])
    with pytest.raises(MeshingError, match="two solids"):
        solids_of_tetrahedra(np.array([(0, 1, 2, 3)]), triangles, sides)


def test_the_jacobian_is_bounded_from_below():
    rows = np.arange(10)[None]
    assert least_jacobians(STRAIGHT, rows) == pytest.approx([1.0])
    random = np.random.default_rng(3)
    for _ in range(20):
        nodes = STRAIGHT.copy()
        nodes[4:] += 0.1 * random.normal(size=(6, 3))
        sampled = min(jacobian(nodes, w) for w in random.dirichlet(np.ones(4), 200))
        assert least_jacobians(nodes, rows)[0] <= sampled + 1e-12


def jacobian(nodes, weights):
    slopes = (4.0 * weights - 1.0)[:, None] * nodes[:4]
    for middle, (a, b) in enumerate(LEGS.tolist(), 4):
        slopes[a] += 4.0 * weights[b] * nodes[middle]
        slopes[b] += 4.0 * weights[a] * nodes[middle]
    return np.linalg.det(slopes[1:] - slopes[0])


@pytest.mark.parametrize("extension", [".vtu", ".msh", ".inp", ".su2", ".mesh"])
@pytest.mark.filterwarnings("ignore::UserWarning")
def test_meshio_reads_the_tetrahedra(extension, boxes, tmp_path):
    meshio = pytest.importorskip("meshio")
    found = fills(boxes, "tetgen")
    path = found.save(tmp_path / f"boxes{extension}")
    read = meshio.read(path, file_format="medit" if extension == ".mesh" else None)
    cells = np.vstack([block.data for block in read.cells if block.type == "tetra"])
    assert len(cells) == len(found.elements)
    np.testing.assert_allclose(read.points, found.nodes, rtol=0, atol=1e-12)
    assert extension == ".inp" or (cells[0] == found.elements[0]).all()


def test_gmsh_knows_solids_and_faces_of_what_is_saved(boxes, tmp_path):
    gmsh = pytest.importorskip("gmsh")
    found = fills(boxes, "tetgen", order=2)
    gmsh.initialize(interruptible=False)
    try:
        gmsh.option.setNumber("General.Terminal", 0)
        gmsh.open(str(found.save(tmp_path / "boxes.msh")))
        (kind,), (tags,), _ = gmsh.model.mesh.getElements(3)
        assert kind == 11 and len(tags) == len(found.elements)
        assert min(gmsh.model.mesh.getElementQualities(tags, "minDetJac")) > 0.0
        dimensions = [dimension for dimension, _ in gmsh.model.getPhysicalGroups()]
        assert dimensions.count(3) == 2 and dimensions.count(2) == 17
    finally:
        gmsh.finalize()


def test_a_model_of_gmsh_is_filled_without_another_call(boxes):
    gmsh = pytest.importorskip("gmsh")
    try:
        assert boxes.to_gmsh("two boxes") is gmsh
        gmsh.model.mesh.generate(3)
        for tag in (1, 2):
            _, (tags,), _ = gmsh.model.mesh.getElements(3, tag)
            assert len(tags) > 20
            assert gmsh.model.getPhysicalName(3, tag) == f"compound {tag - 1}"
        volumes = gmsh.model.mesh.getElementQualities(
            np.concatenate(gmsh.model.mesh.getElements(3)[1]), "volume"
        )
        assert sum(volumes) == pytest.approx(16.0 - 0.8**3, rel=1e-9)
    finally:
        gmsh.finalize()


def test_unknown_extensions_are_refused(boxes, tmp_path):
    with pytest.raises(FileFormatError, match=r"known are \.vtu \.msh \.inp"):
        fills(boxes, "tetgen").save(tmp_path / "boxes.stl")


def test_calculix_bends_a_beam_by_the_names_of_its_faces(tmp_path):
    """A cantilever of second order against the theory of beams with shear."""
    if shutil.which("ccx") is None:
        pytest.skip("ccx is not installed (Debian: calculix-ccx)")
    part = cq.Workplane().box(100, 10, 10, centered=(False, True, True))
    part = part.faces("<X").tag("fixed").end().faces(">X").tag("tip").end()
    mesh = sm.mesh(part, 5.0, order=2)
    ends = [mesh.groups.face_names.index(name) for name in ("fixed", "tip")]
    fills(mesh, "tetgen").save(tmp_path / "beam.inp")
    loaded = len(np.unique(mesh.elements[mesh.face_ids == ends[1]]))
    solid = mesh.groups.solid_label(0).replace(" ", "_")
    (tmp_path / "run.inp").write_text(
        "*INCLUDE, INPUT=beam.inp\n*MATERIAL, NAME=STEEL\n*ELASTIC\n210000, 0.3\n"
        f"*SOLID SECTION, ELSET={solid}, MATERIAL=STEEL\n*BOUNDARY\nfixed, 1, 3\n"
        f"*STEP\n*STATIC\n*CLOAD\ntip, 3, {100.0 / loaded}\n*NODE PRINT, NSET=tip\nU\n*END STEP\n"
    )
    subprocess.run(["ccx", "run"], cwd=tmp_path, check=True, capture_output=True)  # noqa: S607
    rows = [line.split() for line in (tmp_path / "run.dat").read_text().splitlines()]
    tip = np.mean([float(row[3]) for row in rows if len(row) == 4 and row[0].isdigit()])
    bending, shear = 100.0 * 100**3 / 3 / 210000 / (10**4 / 12), 100 * 100 / (5 / 6 * 80769 * 100)
    assert tip == pytest.approx(bending + shear, rel=0.02)
