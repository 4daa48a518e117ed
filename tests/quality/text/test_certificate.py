"""What the report says beyond single figures: places, rows, exact values, fingerprints."""

import hashlib
import json
import pickle
from contextlib import nullcontext
from pathlib import Path

import cadquery as cq
import jsonschema
import numpy as np
import pytest
from handmade_meshes import Saddle, changed, grid, icosphere
from naive import meeting as slow

import surfmesh as sm
from surfmesh.quality.figures.part import Part
from surfmesh.quality.measures.self_intersection import meeting_pairs
from surfmesh.result.model_facts import FaceFacts, ModelFacts
from surfmesh.result.surface_mesh import SurfaceMesh

SCHEMA = json.loads(
    (Path(__file__).parents[3] / "docs" / "report-schema.json").read_text(encoding="utf-8")
)


def together(*meshes):
    """One mesh of several, without surfaces."""
    starts = np.cumsum([0, *(len(mesh.points) for mesh in meshes)])
    return SurfaceMesh(
        points=np.concatenate([mesh.points for mesh in meshes]),
        triangles=np.concatenate([m.triangles + k for m, k in zip(meshes, starts)]),
    )


def shifted(mesh, *by):
    return changed(mesh, points=mesh.points + by, surfaces=())


@pytest.fixture(scope="module")
def plate():
    """60 x 40 x 5 with a hole of diameter 6."""
    solid = cq.Workplane().box(60, 40, 5).faces(">Z").workplane().hole(6)
    return sm.mesh(sm.from_cadquery(solid))


# ------------------------------------------------------------------ self-intersection


def test_two_spheres_that_intersect():
    ball = icosphere(1)
    mesh = together(ball, shifted(ball, 0.7, 0.1, 0))
    report = sm.check(mesh)
    pairs = meeting_pairs(mesh)
    corners = mesh.points[mesh.triangles]
    assert all(slow.meet(corners[i], corners[j]) for i, j in pairs)
    assert report.self_intersections == len(pairs) > 20 and len(report.meeting) == 20
    assert report.problems[0].startswith(
        f"the mesh intersects itself: {len(pairs)} pairs of triangles, first "
        f"{pairs[0, 0]} and {pairs[0, 1]} (face 0) at ("
    )
    for pair in report.meeting:  # on both spheres, as far as triangles of this size are
        for centre in ((0, 0, 0), (0.7, 0.1, 0)):
            assert np.linalg.norm(np.subtract(pair.point, centre)) == pytest.approx(1, abs=0.4)
    assert "intersects itself (" in str(report) and "self-intersections" in report.to_text()


def test_spheres_that_nearly_touch_are_clean():
    ball = icosphere(2)
    report = sm.check(together(ball, shifted(ball, 2 + 1e-12, 0, 0)))
    assert report.clean and report.self_intersections == 0


def test_a_fold_onto_the_neighbour():
    points = [(0, 0, 0), (1, 0, 0), (0.5, 1, 0), (0.4, 0.5, 0)]
    mesh = SurfaceMesh(points=points, triangles=[(0, 1, 2), (1, 0, 3)])
    assert sm.check(mesh).self_intersections == 1
    open_book = changed(mesh, points=[*points[:3], (0.4, 0.5, 1e-9)])
    assert sm.check(open_book).self_intersections == 0


def test_surfaces_that_cross_themselves_by_nature():
    crossing = grid(Saddle(), 4)
    mesh = together(crossing, shifted(crossing, 0.1, 0.05, 0.01))
    assert not sm.check(mesh).clean
    report = sm.check(changed(mesh, facts=ModelFacts(crosses_itself=True)))
    assert report.clean and report.self_intersections > 0 and "by nature" in str(report)


def test_a_formula_that_crosses_itself_must_say_so():
    loop = ("u**3 - u", "u**2", "v")  # a node where u = -1 and u = 1
    domain = {"u": (-1.3, 1.3), "v": (0, 1)}
    silent = sm.mesh(sm.ParametricSurface(*loop, **domain), 0.2)
    assert not silent.report.clean and "embedded = false" in silent.report.problems[0]
    said = sm.mesh(sm.ParametricSurface(*loop, **domain, facts={"embedded": False}), 0.2)
    assert said.report.clean and said.report.crosses_itself


# ------------------------------------------------------------------ the model's own figures


def test_exact_figures_of_a_plate(plate):
    report = plate.report
    hole = 2 * np.pi * 3 * 5
    assert report.clean, report.problems
    assert report.area_exact == pytest.approx(2 * (2400 - 9 * np.pi) + 1000 + hole)
    assert report.volume_exact == pytest.approx(12000 - 45 * np.pi)
    assert report.euler == report.euler_exact == 0
    assert report.unit == "mm" and report.source == "cadquery Workplane"
    assert "exact" in str(report) and "as in the model" in str(report)


def test_rows_of_faces_add_up(plate):
    report = plate.report
    rows = report.by_face
    assert [row.face for row in rows] == list(range(7))
    assert sum(row.triangles for row in rows) == report.triangles
    assert sum(row.area for row in rows) == pytest.approx(report.area)
    assert max(row.deviation_max for row in rows) == pytest.approx(report.deviation_max)
    square = sum(row.deviation_rms**2 * row.area for row in rows)
    assert square / report.area == pytest.approx(report.deviation_rms**2)
    for row in rows:
        flat = row.kind == "plane"
        assert row.deviation_max < 1e-12 if flat else row.deviation_max > 0.01
        assert row.area == pytest.approx(row.area_exact, rel=0.01)
        assert 0.5 < row.size_mean / row.size_wanted < 2
        assert plate.face_ids[row.deviation_triangle] == row.face
        assert row.alpha_min <= row.alpha_mean + 1e-12
    assert min(row.alpha_min for row in rows) == report.alpha_min


def test_sizes_of_a_row_against_a_slow_sum(saddle):
    for row in sm.check(saddle).by_face:
        corners = saddle.triangles[saddle.face_ids == row.face]
        edges = {tuple(sorted((t[i], t[i - 1]))) for t in corners.tolist() for i in range(3)}
        steps = [np.linalg.norm(saddle.points[a] - saddle.points[b]) for a, b in edges]
        assert row.size_mean == pytest.approx(np.mean(steps))
        assert row.size_wanted == pytest.approx(0.3)


def test_a_wrong_euler_number_is_a_problem(tetrahedron):
    good = changed(tetrahedron, facts=ModelFacts(euler=2))
    assert sm.check(good).clean
    bad = sm.check(changed(tetrahedron, facts=ModelFacts(euler=0)))
    assert bad.problems == ("the Euler number of the mesh is 2, that of the model 0",)


def test_solids_that_share_a_face():
    first, second = cq.Solid.makeBox(1, 1, 1), cq.Solid.makeBox(2, 1, 1, cq.Vector(1, 0, 0))
    from OCP.BOPAlgo import BOPAlgo_Builder

    fuse = BOPAlgo_Builder()
    fuse.AddArgument(first.wrapped)
    fuse.AddArgument(second.wrapped)
    fuse.Perform()
    report = sm.mesh(sm.from_cadquery(cq.Shape.cast(fuse.Shape()))).report
    assert report.clean, report.problems
    assert sorted(row.volume for row in report.by_solid) == pytest.approx([1, 2])
    assert sorted(row.area for row in report.by_solid) == pytest.approx([6, 10])
    assert all(row.euler == row.euler_exact == 2 and row.closed for row in report.by_solid)
    assert report.volume == pytest.approx(report.volume_exact) == pytest.approx(3)


def test_bodies_may_touch():
    boxes = [cq.Solid.makeBox(1, 1, 1), cq.Solid.makeBox(1, 1, 1, cq.Vector(1, 0.3, 0.2))]
    report = sm.mesh(sm.from_cadquery(boxes)).report
    assert report.clean and report.contacts > 0 and report.self_intersections == 0
    assert report.volume == pytest.approx(2) and "separate bodies meet" in str(report)


# ------------------------------------------------------------------ places


def test_worst_triangles(plate):
    worst = plate.worst(20)
    assert len(worst) == 20 and worst == plate.report.worst
    assert [w.alpha for w in worst] == sorted(w.alpha for w in worst)
    assert worst[0].alpha == plate.report.alpha_min
    for found in worst[:3]:
        centre = plate.points[list(found.corners)].mean(axis=0)
        assert found.point == pytest.approx(tuple(centre)) and found.name.startswith("face ")
        assert found.face == plate.face_ids[found.triangle]
    assert plate.worst(3) == worst[:3] and plate.worst(0) == ()
    assert len(plate.worst(10**6)) == len(plate.triangles)
    with pytest.raises(TypeError, match=r"as in worst\(20\), not 'a'"):
        plate.worst("a")


def test_folded_triangles_are_named():
    mesh = grid(Saddle(), 6)
    triangles, uv = mesh.triangles.copy(), mesh.uv_triangles.copy()
    triangles[10], uv[10] = triangles[10, [1, 0, 2]], uv[10, [1, 0, 2]]
    report = sm.check(changed(mesh, triangles=triangles, uv_triangles=uv))
    (found,) = report.folded_at
    assert found.triangle == 10 and found.angle_deg > 150 and report.by_face[0].folded == 1
    assert "folded triangles" in report.to_text()


def test_histograms_count_everything(plate):
    report = plate.report
    for name, found in report.histograms.items():
        many = len(plate.edges) if name == "length" else report.triangles
        assert sum(found.counts) == many and len(found.edges) == len(found.counts) + 1
    counts, _ = np.histogram([w.alpha for w in plate.worst(10**6)], 20, (0, 1))
    assert report.histograms["alpha"].counts == tuple(counts.tolist())


# ------------------------------------------------------------------ where it came from


def test_fingerprints(tetrahedron):
    content = tetrahedron.points.astype("<f8").tobytes()
    content += tetrahedron.triangles.astype("<i4").tobytes()
    assert sm.check(tetrahedron).mesh_sha256 == hashlib.sha256(content).hexdigest()
    moved = changed(tetrahedron, points=np.nextafter(tetrahedron.points, 9))
    assert sm.check(moved).mesh_sha256 != sm.check(tetrahedron).mesh_sha256
    assert {"surfmesh", "numpy", "python"} <= set(sm.check(tetrahedron).versions)
    domain = {"u": (0, 1), "v": (0, 1)}
    same, other = (sm.mesh(sm.ParametricSurface("u", "v", z, **domain), 0.5) for z in ("u", "v"))
    again = sm.mesh(sm.ParametricSurface("u", "v", "u", **domain), 0.7)
    assert same.facts.sha256 == again.facts.sha256 != other.facts.sha256


def test_a_file_its_mesh_and_the_command(tmp_path, capsys, monkeypatch):
    from surfmesh.cli import commands, main

    path, mesh_path = tmp_path / "box.brep", str(tmp_path / "box.vtu")
    cq.Workplane().box(1, 2, 3).val().exportBrep(str(path))
    model = sm.load(path)
    mesh = sm.mesh(model)
    assert mesh.report.source == "box.brep" and "cadquery-ocp" in mesh.report.versions
    assert mesh.report.source_sha256 == hashlib.sha256(path.read_bytes()).hexdigest()
    mesh.save(mesh_path)
    # read once is enough
    monkeypatch.setattr(commands, "surface_begun", lambda *_: nullcontext(lambda: model))
    assert main(["check", mesh_path, "--surface", str(path)]) == 0
    printed = capsys.readouterr().out
    for words in ("faces\n", "solids\n", "worst triangles\n", "as in the model", "sha256"):
        assert words in printed
    assert main(["check", mesh_path, "--surface", str(path), "--json"]) == 0
    content = json.loads(capsys.readouterr().out)
    jsonschema.validate(content, SCHEMA)
    assert content["mesh_sha256"] == mesh.report.mesh_sha256
    assert content["volume_exact"] == pytest.approx(6) and len(content["worst"]) == 20
    assert main(["check", mesh_path, "--json"]) == 0
    content = json.loads(capsys.readouterr().out)
    assert content["source"] == "box.vtu"
    assert content["source_sha256"] == hashlib.sha256(Path(mesh_path).read_bytes()).hexdigest()


def test_the_report_of_a_mesh_is_kept_but_does_not_travel(tetrahedron):
    assert tetrahedron.report is tetrahedron.report
    there = pickle.loads(pickle.dumps(tetrahedron))
    assert "report" not in there.__dict__ and there.report.nodes == 4


# ------------------------------------------------------------------ JSON


def test_the_schema_knows_every_field(tetrahedron):
    jsonschema.Draft202012Validator.check_schema(SCHEMA)
    report = sm.check(tetrahedron)
    assert sorted(SCHEMA["required"]) == sorted(report.to_dict())
    for part in (held for held in vars(report).values() if isinstance(held, Part)):
        assert all(getattr(report, name) is value for name, value in vars(part).items())
    assert SCHEMA["properties"]["schema_version"]["const"] == 4


def test_reports_follow_the_schema(plate, saddle, moebius_band, tetrahedron):
    broken = SurfaceMesh(points=[(0, 0, 0), (1, 0, 0), (0, np.inf, 0)], triangles=[(0, 1, 2)])
    empty = SurfaceMesh(points=np.empty((0, 3)), triangles=np.empty((0, 3)))
    crossed = together(icosphere(1), shifted(icosphere(1), 0.5, 0, 0))
    flipped = changed(grid(Saddle(), 4), turned_faces=[True])
    for mesh in (plate, saddle, moebius_band, tetrahedron, broken, empty, crossed, flipped):
        report = sm.check(mesh)
        jsonschema.validate(json.loads(report.to_json()), SCHEMA)
        assert report.to_text().startswith(str(report))
    unknown = changed(tetrahedron, facts=ModelFacts(faces=(FaceFacts("plane", 1.0),)))
    assert sm.check(unknown).by_face[0].area_exact == 1.0


def test_face_numbers_of_any_size(saddle):
    tagged = changed(saddle, face_ids=saddle.face_ids * 2_000_000_000 - 5, surfaces=())
    rows = sm.check(tagged).by_face
    assert [row.face for row in rows] == [-5, 1_999_999_995]
    assert [row.triangles for row in rows] == [64, 64] and sm.check(tagged).faces == 2
    shifted = sm.check(changed(saddle, face_ids=saddle.face_ids + 1))
    assert shifted.by_face == () and "face_ids run from 1 to 2" in shifted.problems[0]


def test_the_exit_status_tells_of_self_intersection(tmp_path, capsys):
    from surfmesh.cli import main

    ball = icosphere(1)
    for shift, status in ((0.7, 1), (2.5, 0)):
        path = str(tmp_path / f"balls{status}.stl")
        together(ball, shifted(ball, shift, 0.1, 0)).save(path)
        assert main(["check", path]) == status
        assert ("the mesh intersects itself" in capsys.readouterr().out) == bool(status)


def test_rounding_is_called_rounding():
    """A box has flat faces: no 2.7e-16 is said of them, in words or on the page."""
    report = sm.check(sm.mesh(cq.Workplane().box(4, 2, 2), 0.5))
    said = str(report)
    assert "deviation  none beyond rounding" in said and "e-1" not in said
    assert "volume 16 (exact 16, to rounding)" in said
    assert 0.0 <= report.deviation_max < 1e-15
