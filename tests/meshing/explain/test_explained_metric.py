"""explain where sizes depend on the direction: both axes of the metric, and the rule of each."""

import json

import cadquery as cq
import numpy as np
import pytest

import surfmesh as sm
from surfmesh.cli import main
from surfmesh.sizing.metric_roots import unpacked


@pytest.fixture(scope="module")
def tube():
    return sm.from_cadquery(cq.Workplane().circle(5).circle(4).extrude(60))


def test_a_cylinder_is_straight_one_way(tube):
    found = sm.explain(tube, sm.Sizing(chord=0.02, anisotropy=10), (0, 5, 30))
    short, long = found.axes
    # h^2 / (8 R) is 75 % of the chord
    assert short.size == pytest.approx(np.sqrt(0.75 * 0.02 * 8 * 5), rel=1e-3)
    assert np.abs(short.direction) == pytest.approx([1, 0, 0], abs=1e-6)
    assert short.winner.rule == "chord 0.02 at curvature 0.2 (radius 5)"
    assert short.radius == pytest.approx(5.0)
    assert np.abs(long.direction) == pytest.approx([0, 0, 1], abs=1e-6)
    assert long.size == pytest.approx(10 * short.size, rel=1e-3) and found.ratio > 9.9
    assert long.winner.rule.startswith("anisotropy 10") and long.radius is None
    assert (found.size, found.winner) == (short.size, short.winner)
    assert np.allclose(found.curvatures, (0.2, 0.0))


@pytest.mark.parametrize(
    "extra, rule",
    [
        ({"edge:%CIRCLE": 0.3}, "size 0.3"),
        ({">Z": 0.3}, "size 0.3"),
        ({"type:cylinder": sm.Sizing(chord=0.002)}, "chord 0.002 at curvature 0.2 (radius 5)"),
        ({"type:cylinder": sm.Sizing(angle=2.0)}, "angle 2 degrees at curvature 0.2 (radius 5)"),
        ({"*": sm.Sizing(chord=0.02, anisotropy=10, min_size=2.0)}, "min_size 2"),
    ],
    ids=["edge", "face beside it", "chord", "angle", "min_size"],
)
def test_the_rule_of_a_selection_wins(tube, extra, rule):
    sizes = {"*": sm.Sizing(chord=0.02, anisotropy=10), **extra}
    short, long = sm.explain(tube, sizes, (0, 5, 58)).axes
    assert short.winner.rule == rule and short.winner.key in extra
    if rule == "size 0.3":
        assert short.origin.startswith("grown from edge") and short.size < short.target_size
        assert long.origin.startswith("shrunk with the other size, grown from edge")
    else:
        assert not short.origin and short.size == pytest.approx(short.winner.size, rel=0.01)


def test_an_edge_has_curvature_of_its_own(tube):
    sizes = {"*": sm.Sizing(chord=0.02, anisotropy=10), "type:cylinder": {"min_size": 2.0}}
    short, _ = sm.explain(tube, sizes, (0, 5, 58)).axes  # the plane beside it has no such bound
    assert "edge" in short.origin
    assert short.winner.rule == "chord 0.02 at the edge's own curvature 0.25 (radius 4)"


def test_a_plane_between_has_one_size_in_all_directions(tube):
    found = sm.explain(tube, sm.Sizing(chord=0.02, anisotropy=10), (0, 4.5, 60))
    assert found.ratio == 1.0 and [axis.origin for axis in found.axes] == [found.origin] * 2
    assert "grown from edge" in found.origin


def test_the_numbers_are_those_of_the_field():
    """Where nothing has grown from elsewhere the row that decides gives the size of the field."""
    torus, sizing = sm.load("torus"), sm.Sizing(chord=0.01, anisotropy=4)
    mesh = sm.mesh(torus, sizing, optimise=False)
    plain = 0
    for vertex in range(5, len(mesh.points), len(mesh.points) // 40):
        found = sm.explain(torus, sizing, mesh.points[vertex])
        corner = int(np.flatnonzero(mesh.triangles.ravel() == vertex)[0])
        w = mesh.metric_root_3d[mesh.uv_triangles.ravel()[corner]]
        w = unpacked(w)
        for axis in found.axes:
            assert np.linalg.norm(w @ axis.direction) == pytest.approx(1 / axis.size, rel=0.02)
            if axis.is_raised:
                assert "raised as the other size is not reached" in axis.lines()[0]
            elif not axis.origin:
                assert axis.size == pytest.approx(axis.winner.size, rel=0.05)
                plain += 1
        a, b = (np.array(axis.direction) for axis in found.axes)
        assert abs(a @ b) < 1e-9 and found.axes[0].size <= found.axes[1].size
    assert plain > 40


def test_no_axes_without_anisotropy(tube):
    found = sm.explain(tube, 2.0, (0, 5, 30))
    assert found.axes == () and found.ratio == 1.0
    assert found.size == pytest.approx(2.0)
    assert "principal curvatures 0.2, 0 (radii 5, infinite)" in str(found)


def test_a_point_on_a_seam_stays_where_it_is(tube):
    found = sm.explain(tube, 2.0, (5, 0, 30))
    assert found.point == pytest.approx((5, 0, 30), abs=1e-6) and found.distance < 1e-6


def test_on_the_command_line(tmp_path, capsys):
    part = cq.Workplane().circle(5).extrude(60)
    cq.exporters.export(part, str(tmp_path / "rod.step"))
    argv = ["explain", str(tmp_path / "rod.step"), "--at", "0", "5", "30", "--chord", "0.02"]
    argv += ["--anisotropy", "10"]
    assert main(argv) == 0
    printed = capsys.readouterr().out
    assert "(ratio 10)" in printed and "along (0, 0, " in printed and "'*' decides" in printed
    assert main([*argv, "--json"]) == 0
    found = json.loads(capsys.readouterr().out)
    assert found["ratio"] == pytest.approx(10, rel=0.01) and len(found["axes"]) == 2
    assert found["axes"][0]["radius"] == pytest.approx(5.0)
    assert found["axes"][0]["winner"]["rule"].startswith("chord 0.02")
