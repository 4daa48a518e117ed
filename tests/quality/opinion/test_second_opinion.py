"""What trimesh and PyVista say beside the report: they agree where it is right, and where it is
not the mesh is not clean."""

import json
from dataclasses import fields, is_dataclass, replace
from fractions import Fraction
from pathlib import Path

import jsonschema
import numpy as np
import pytest
from handmade_meshes import changed, icosphere
from hypothesis import given, settings
from hypothesis import strategies as st

from surfmesh.cli import main
from surfmesh.quality import check
from surfmesh.quality.measures.shape import enclosed_volume
from surfmesh.quality.opinion.rounding_bounds import bounds, placed
from surfmesh.quality.report import with_second_opinion
from surfmesh.result.surface_mesh import SurfaceMesh
from surfmesh.view import html_report

SCHEMA = json.loads(
    (Path(__file__).parents[3] / "docs" / "report-schema.json").read_text(encoding="utf-8")
)
ALL = 19  # figures of a closed surface


def agreed(mesh):
    """The opinion, which must have nothing against the report."""
    report = check(mesh, second_opinion=True)
    found = report.second_opinion
    assert found.disagreements == () and found.agreed == found.compared > 0
    assert not any("second opinion" in said for said in (*report.problems, *report.warnings))
    return found


def row(found, whose, quantity, of=""):
    (only,) = [r for r in found.rows if (r.whose, r.quantity, r.of) == (whose, quantity, of)]
    return only


def box(low=(0, 0, 0), high=(1, 1, 1)):
    """Eight points, x slowest, and twelve triangles that face outwards, those at low x first."""
    ends = np.array((low, high), float)
    points = np.array([ends[[i, j, k], [0, 1, 2]] for i in (0, 1) for j in (0, 1) for k in (0, 1)])
    quads = [(0, 1, 3, 2), (4, 6, 7, 5), (0, 4, 5, 1), (2, 3, 7, 6), (0, 2, 6, 4), (1, 5, 7, 3)]
    return points, np.array([t for a, b, c, d in quads for t in ((a, b, c), (a, c, d))])


def together(*parts, solids=None):
    """One mesh of (points, triangles), each a solid of its own where solids is true."""
    starts = np.cumsum([0, *(len(points) for points, _ in parts)])
    ids = np.repeat(np.arange(len(parts)), [len(triangles) for _, triangles in parts])
    return SurfaceMesh(
        points=np.vstack([points for points, _ in parts]),
        triangles=np.vstack([triangles + k for (_, triangles), k in zip(parts, starts)]),
        solid_ids=np.column_stack((ids, np.full(len(ids), -1))) if solids else None,
    )


def boxes_that_share_a_wall():
    points, triangles = box()
    beyond, right = box((1, 0, 0), (2, 1, 1))
    number = np.array([4, 5, 6, 7, 8, 9, 10, 11])
    ids = np.full((22, 2), -1)
    ids[:12, 0], ids[12:, 0], ids[2:4, 1] = 0, 1, 1
    return SurfaceMesh(
        points=np.vstack((points, beyond[4:])),
        triangles=np.vstack((triangles, number[right[2:]])),
        solid_ids=ids,
    )


BALL = icosphere(2)
FLAT = changed(BALL, surfaces=(), uv_points=None, uv_triangles=None)


def ball(*, triangles=BALL.triangles, points=BALL.points):
    return SurfaceMesh(points=points, triangles=triangles)


def without_joining():
    """The ball cut along its equator, the two sides of the cut in one place: no vertex shared."""
    upper = BALL.points[BALL.triangles].mean(axis=1)[:, 2] > 0
    return ball(
        points=np.vstack((BALL.points, BALL.points)),
        triangles=np.where(upper[:, None], BALL.triangles, BALL.triangles + len(BALL.points)),
    ).submesh(np.ones(len(upper), bool))


FLIPPED = BALL.triangles.copy()
FLIPPED[7] = FLIPPED[7, ::-1]
MESHES = {
    "closed": ball(),
    "inside out": ball(triangles=BALL.triangles[:, ::-1]),
    "a hole": ball(triangles=BALL.triangles[1:]),
    "one triangle turned": ball(triangles=FLIPPED),
    "one triangle twice": ball(triangles=np.vstack((BALL.triangles, BALL.triangles[5:6]))),
    "one triangle": ball(triangles=BALL.triangles[:1]),
    "not joined": without_joining(),
    "a fin": ball(
        points=np.vstack((BALL.points, [(2, 2, 2)])),
        triangles=np.vstack((BALL.triangles, [(*BALL.triangles[0, :2], len(BALL.points))])),
    ),
    "balls apart": together((BALL.points, BALL.triangles), (BALL.points + 3, BALL.triangles)),
    "a void": together(box(), (box((0.25,) * 3, (0.5,) * 3)[0], box()[1][:, ::-1])),
    "boxes that touch": together(box(), box((1, 0, 0), (2, 1, 1)), solids=True),
    "boxes that share a wall": boxes_that_share_a_wall(),
    "a vertex of no triangle": ball(points=np.vstack((BALL.points, [(9e9, 0, 0)]))),
    "far away": ball(points=BALL.points + (1e6, -1e6, 1e6)),
    "far away along x": ball(points=BALL.points + (1e9, 0, 0)),
    "tiny": ball(points=1e-6 * BALL.points),
    "tiny and far away": ball(points=1e-6 * BALL.points + 1.0),
    "of atoms": ball(points=1e-50 * BALL.points),
    "of galaxies": ball(points=1e50 * BALL.points),
    "sheared": ball(points=BALL.points @ np.array([(1, 0, 0), (1e3, 1, 0), (0, 0, 1)], float)),
    "flat": ball(points=BALL.points * (1, 1, 1e-7)),
    "long": ball(points=BALL.points * (1e7, 1, 1)),
    "without thickness": ball(points=BALL.points * (1, 1, 0)),
    "two corners in one place": ball(points=BALL.points[np.r_[0, 0, 2 : len(BALL.points)]]),
}


@pytest.mark.parametrize("name", MESHES)
def test_they_agree_on_what_is_so(name):
    agreed(MESHES[name])


def test_all_figures_of_a_closed_surface_are_compared():
    found = agreed(MESHES["closed"])
    assert found.compared == found.agreed == len(found.rows) == ALL
    assert row(found, "trimesh", "watertight").theirs is True
    assert row(found, "pyvista", "Euler number").theirs == 2
    assert row(found, "pyvista", "volume").theirs == pytest.approx(4.047044679978852)
    for name in ("far away", "tiny", "inside out", "a void", "of galaxies"):
        assert agreed(MESHES[name]).compared == ALL, name


def test_what_they_say_of_faults():
    found = agreed(MESHES["a hole"])
    assert row(found, "trimesh", "watertight").theirs is False
    assert row(found, "pyvista", "edges not of two triangles").theirs == 3
    assert row(found, "trimesh", "volume").note == "nothing is enclosed"
    found = agreed(MESHES["one triangle turned"])
    assert row(found, "trimesh", "winding consistent").theirs is False
    found = agreed(MESHES["a fin"])
    assert row(found, "pyvista", "non-manifold edges").theirs == 1
    found = agreed(MESHES["not joined"])
    assert row(found, "trimesh", "components").theirs == 2
    assert row(found, "pyvista", "components").theirs == 2  # nothing was merged


def test_a_one_sided_surface(moebius_band):
    found = agreed(replace(moebius_band, one_sided=True))
    assert row(found, "trimesh", "winding consistent").theirs is False
    assert row(found, "trimesh", "volume").agree is None


def test_solids_one_by_one():
    found = agreed(MESHES["boxes that share a wall"])
    for whose in ("trimesh", "pyvista"):
        assert row(found, whose, "volume").theirs == pytest.approx(2.0, rel=1e-14)
    assert row(found, "pyvista", "non-manifold edges").theirs == 4
    for solid in ("solid 0", "solid 1"):
        assert row(found, "trimesh", "volume", solid).theirs == 1.0
        assert row(found, "trimesh", "closed", solid).theirs is True
    found = agreed(MESHES["boxes that touch"])
    assert len(found.rows) == ALL + 2 * 4


def test_a_solid_that_touches_itself_along_an_edge_is_closed():
    (points, triangles), (beyond, _) = box(), box((1, 1, 0), (2, 2, 1))
    number = np.array([6, 7, 8, 9, 10, 11, 12, 13])
    ids = np.column_stack((np.zeros(24, int), np.full(24, -1)))
    mesh = SurfaceMesh(
        points=np.vstack((points, beyond[2:])),
        triangles=np.vstack((triangles, number[triangles])),
        solid_ids=ids,
    )
    found = agreed(mesh)
    assert row(found, "trimesh", "watertight").theirs is False  # an edge of four triangles
    assert row(found, "trimesh", "closed", "solid 0").theirs is True
    assert row(found, "trimesh", "volume", "solid 0").theirs == 2.0


def test_a_small_solid_far_from_the_others_keeps_its_volume():
    """Volumes were to the middle of the whole mesh: of a small part few digits were right."""
    small = box((1e6,) * 3, np.full(3, 1e6) + 2.0**-10)
    found = agreed(together(box(), small, solids=True))
    volume = row(found, "trimesh", "volume", "solid 1")
    assert volume.ours == pytest.approx(2.0**-30, rel=1e-12) and volume.agree


# ------------------------------------------------------------------ where the report is wrong

FORGED = {
    "euler": (3, ["trimesh Euler number", "pyvista Euler number"]),
    "components": (2, ["trimesh components", "pyvista components"]),
    "closed": (False, ["trimesh watertight"]),
    "oriented": (False, ["trimesh winding consistent"]),
    "boundary_edges": (1, ["pyvista edges not of two triangles"]),
    "area": (12.3298485953, ["trimesh area", "pyvista area"]),
    "volume": (-4.047044679978852, ["trimesh volume"]),  # VTK's have no sign
    "alpha_min": (0.97727, ["pyvista alpha_min"]),
    "alpha_mean": (0.9885, ["pyvista alpha_mean"]),
    "min_angle_deg": (54.397013, ["pyvista min_angle_deg"]),
    "max_angle_deg": (float("nan"), ["pyvista max_angle_deg"]),
}


def forged(report, name, wrong):
    """The report with another figure."""
    for part in fields(report):
        held = getattr(report, part.name)
        if is_dataclass(held) and name in vars(held):
            return replace(report, **{part.name: replace(held, **{name: wrong})})
    raise AttributeError(name)


@pytest.mark.parametrize("field", FORGED)
def test_a_wrong_figure_is_a_problem(field):
    wrong, who = FORGED[field]
    mesh = MESHES["closed"]
    right = check(mesh)
    assert right.clean and right.second_opinion is None
    report = with_second_opinion(forged(right, field, wrong), mesh)
    named = [f"{row.whose} {row.quantity}" for row in report.second_opinion.disagreements]
    assert named == who and not report.clean
    assert len(report.problems) == len(who) and all("\n" not in said for said in report.problems)
    assert report.problems[0].startswith(f"second opinion: {who[0].split(maxsplit=1)[1]} is ")
    assert f"disagree: {who[0].split(maxsplit=1)[1]}" in str(report)


def test_a_wrong_solid_is_a_problem():
    mesh = MESHES["boxes that share a wall"]
    right = check(mesh)
    rows = tuple(replace(row, volume=row.volume + 1e-9, closed=False) for row in right.by_solid)
    report = with_second_opinion(replace(right, by_solid=rows), mesh)
    assert len(report.second_opinion.disagreements) == 4
    assert [said for said in report.problems if "1 more of this kind" in said] == [
        said for said in report.problems if "second opinion" in said
    ]


def test_wrong_shapes_are_found_on_one_triangle(monkeypatch):
    from surfmesh.quality.opinion import second_opinion as module

    def bent(mesh):
        found = original(mesh)
        return found._replace(alpha=np.where(np.arange(len(found.alpha)) == 5, 0.5, found.alpha))

    original = module.shapes
    monkeypatch.setattr(module, "shapes", bent)
    found = check(MESHES["closed"], second_opinion=True).second_opinion
    assert row(found, "pyvista", "alpha by triangles", "triangle 5").agree is False


# ------------------------------------------------------------------ what cannot be compared


def test_a_library_that_raises_is_a_warning_and_nothing_else(monkeypatch):
    import pyvista
    import trimesh

    def fail(*_, **__):
        raise RuntimeError("no\nthank you")

    monkeypatch.setattr(pyvista.PolyData, "cell_quality", fail)
    monkeypatch.setattr(trimesh, "Trimesh", fail)
    report = check(MESHES["closed"], second_opinion=True)
    assert report.clean and report.second_opinion.compared == 5  # counts and volume of VTK
    assert row(report.second_opinion, "trimesh", "area").agree is None
    first, second = report.warnings
    assert first == (
        "second opinion: trimesh gave none on watertight and 5 more: RuntimeError: no thank you"
    )
    assert second.startswith("second opinion: pyvista gave none on area and 7 more: RuntimeError")


@pytest.mark.filterwarnings("ignore:invalid value")
def test_points_that_are_no_numbers():
    points = BALL.points.copy()
    points[3, 1] = np.nan
    report = check(ball(points=points), second_opinion=True)
    found = report.second_opinion
    assert found.disagreements == () and row(found, "trimesh", "watertight").agree is True
    assert row(found, "trimesh", "area").note == "not all points are finite"
    assert all(row.agree is None for row in found.rows if row.whose == "pyvista")


def test_a_repeated_corner_and_no_triangle_at_all():
    triangles = BALL.triangles.copy()
    triangles[0, 1] = triangles[0, 0]
    found = check(ball(triangles=triangles), second_opinion=True).second_opinion
    assert found.disagreements == () and row(found, "trimesh", "Euler number").agree is True
    assert row(found, "pyvista", "Euler number").note.startswith("a triangle repeats a corner")
    empty = SurfaceMesh(points=np.empty((0, 3)), triangles=np.empty((0, 3)))
    assert check(empty, second_opinion=True).second_opinion.rows == ()


def test_lengths_whose_products_are_no_doubles():
    found = check(ball(points=1e-70 * BALL.points), second_opinion=True).second_opinion
    assert found.compared == 8 and found.agreed == 8
    assert "their products are no doubles" in row(found, "trimesh", "area").note


# ------------------------------------------------------------------ any triangles whatever

SOUPS = st.lists(
    st.lists(st.integers(0, 7), min_size=3, max_size=3, unique=True), min_size=1, max_size=14
)


@settings(max_examples=200)
@given(SOUPS, st.integers(0, 2**31))
def test_they_agree_on_any_soup(triangles, seed):
    points = np.random.default_rng(seed).normal(size=(8, 3))
    found = check(SurfaceMesh(points=points, triangles=triangles), second_opinion=True)
    assert found.second_opinion.disagreements == ()
    assert found.second_opinion.compared >= 17


# ------------------------------------------------------------------ rounding


@settings(max_examples=60)
@given(
    st.integers(0, 2**31), st.floats(-6, 6), st.floats(-9, 9),
    st.tuples(*[st.sampled_from((-1.0, 0.0, 1.0))] * 3),
)  # fmt: skip
def test_placing_rounds_nothing_and_volumes_keep_to_their_bound(seed, size, distance, direction):
    rng = np.random.default_rng(seed)
    turn = rng.normal(size=(3, 3)) * 10.0 ** rng.uniform(-3, 0, 3)
    mesh = icosphere(0)
    points = 10.0**size * (mesh.points @ turn + 10.0**distance * np.array(direction))
    near = placed(points, mesh.triangles)
    scale = Fraction(2) ** near.exponent
    corner, moved = (
        [list(map(Fraction, place)) for place in array.tolist()] for array in (points, near.points)
    )
    for k in range(12):
        for i in range(3):
            assert (moved[k][i] - moved[0][i]) * scale == corner[k][i] - corner[0][i]
    assert np.abs(near.points).max() <= 2.0

    def exact(a, b, c):
        return (
            a[0] * (b[1] * c[2] - b[2] * c[1])
            + a[1] * (b[2] * c[0] - b[0] * c[2])
            + a[2] * (b[0] * c[1] - b[1] * c[0])
        )

    volume = sum(exact(*(moved[k] for k in corners)) for corners in mesh.triangles.tolist()) / 6
    found = enclosed_volume(SurfaceMesh(points=near.points, triangles=mesh.triangles))
    bound = bounds(near).volume
    assert abs(Fraction(found) - volume) <= bound <= 1e-12


# ------------------------------------------------------------------ how it is said


def test_text_json_and_page(tmp_path, capsys):
    path = str(ball().save(tmp_path / "ball.vtu"))
    assert main(["check", path]) == 0 and "opinion" not in capsys.readouterr().out
    assert main(["check", path, "--second-opinion"]) == 0
    said = capsys.readouterr().out
    assert f"opinion    trimesh and pyvista agree on {ALL} of {ALL} figures" in said
    assert "\nsecond opinion\n" in said
    assert main(["check", path, "--second-opinion", "--json"]) == 0
    content = json.loads(capsys.readouterr().out)
    jsonschema.validate(content, SCHEMA)
    assert content["second_opinion"]["agreed"] == ALL
    page = tmp_path / "ball.html"
    assert main(["report", path, "-o", str(page), "--second-opinion", "--json"]) == 0
    assert f"Second opinion ({ALL} of {ALL} figures agree)" in page.read_text("utf-8")
    jsonschema.validate(json.loads(capsys.readouterr().out) | {"files": {}}, SCHEMA)


def test_the_page_of_a_disagreement_opens_there(tmp_path):
    wrong = with_second_opinion(forged(check(FLAT), "euler", 3), FLAT)
    text = html_report(FLAT, tmp_path / "a.html", report=wrong).read_text("utf-8")
    assert "<details open><summary>Second opinion (17 of 19 figures agree)" in text
    section = text[text.index("Second opinion (") : text.index("Histograms")]
    assert section.count("<td>NO</td>") == 2
    assert section.index("<td>NO</td>") < section.index("<td>yes</td>")
    assert "pairs overlap" not in text  # there are no bodies
    jsonschema.validate(json.loads(wrong.to_json()), SCHEMA)
    mesh = MESHES["boxes that touch"]
    assert "0 pairs overlap" in html_report(mesh, tmp_path / "b.html").read_text("utf-8")
