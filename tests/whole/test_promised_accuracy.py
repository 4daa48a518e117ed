"""chord, angle and growth are kept, and not by much more than was asked for."""

import cadquery as cq
import numpy as np
import pytest

from surfmesh import Sizing, check, from_cadquery, load, mesh


@pytest.mark.parametrize(
    "name, asked",
    [
        ("torus", dict(angle=20)),
        ("two_peaks", dict(angle=20)),
        ("sphere", dict(angle=10)),
        ("mobius", dict(angle=10)),
        ("cone", dict(angle=30)),
        ("torus", dict(angle=15, anisotropy=5)),
        ("cylinder", dict(angle=10, anisotropy=5)),
        ("monkey_saddle", dict(angle=15, chord=0.01)),
    ],
)
def test_neighbours_turn_by_no_more_than_angle(name, asked):
    report = check(mesh(load(name), Sizing(**asked)))
    assert report.clean, report.problems
    assert report.angle == asked["angle"] and report.above_angle_share == 0.0
    assert 0.8 * report.angle < report.angle_max <= report.angle * (1 + 1e-9)
    if report.chord:
        assert report.deviation_max <= report.chord


def test_angle_is_kept_on_cad_faces_not_across_their_edges():
    import cadquery as cq

    part = cq.Workplane().box(10, 8, 6).edges("|Z").fillet(2).faces(">Z").workplane().hole(3)
    report = check(mesh(from_cadquery(part), Sizing(angle=15)))
    assert report.clean, report.problems
    assert 0.5 * 15 < report.angle_max <= 15 * (1 + 1e-9)
    rows = {row.kind: row for row in report.by_face}
    assert rows["plane"].angle_max < 1e-5 and rows["cylinder"].angle_max > 5
    assert all(row.above_angle_share == 0.0 for row in report.by_face)


def test_without_angle_nothing_is_promised():
    report = check(mesh(load("sphere"), Sizing(chord=0.02)))
    assert report.angle is None and report.above_angle_share is None
    assert report.angle_max > 10 and report.clean


@pytest.mark.parametrize("name", ["torus", "ellipsoid", "catenoid", "trefoil", "mobius", "klein"])
def test_at_least_half_of_chord_is_used_where_it_decides(name):
    report = check(mesh(load(name)))
    assert report.deviation_max <= report.chord
    assert report.chord_used >= 0.5 and report.chord_decided_share > 0.2


def test_half_of_chord_is_used_on_fillets():
    import cadquery as cq

    part = cq.Workplane().box(10, 8, 6).edges().fillet(1.5)
    report = check(mesh(from_cadquery(part), Sizing(chord=0.02)))
    assert report.deviation_max <= report.chord
    assert report.chord_used >= 0.5


def test_growth_on_the_result():
    """At a vertex of degree about six, two edges differ by the slope over one edge either way,
    and by what a triangle may be from equilateral."""
    slope = 0.15

    def law(points):
        return 0.02 + slope * np.linalg.norm(points[:, :2], axis=1)

    report = check(mesh(load("plane"), Sizing(size=law, growth=1.2)))
    # from h (1 - slope / 2) to h (1 + slope / 2); edges are within a factor 1.45 / 0.66 at worst
    graded = (1 + slope / 2) / (1 - slope / 2)
    assert graded < report.growth_p99 < 1.45 * graded
    assert report.growth_max < 1.45 / 0.66 * graded


@pytest.mark.parametrize("anisotropy, chord", [(1, 1e-3), (8, 5e-4)])
def test_chord_is_kept_where_triangles_are_measured_only_when_they_come_near_it(anisotropy, chord):
    """More than 20,000 triangles: from there the mesher remembers what it has measured."""
    made = mesh(load("two_peaks"), Sizing(chord=chord, anisotropy=anisotropy))
    report = check(made)
    assert len(made.triangles) > 20_000
    assert 0.9 * report.chord < report.deviation_max <= report.chord


def cut_cone():
    """A cone whose hyperbolas, where a slot cuts it, bend much more at one end."""
    slot = cq.Workplane().box(1.0, 20.0, 2.6).translate((0.8, 0.0, 0.0))
    return cq.Workplane(cq.Solid.makeCone(1.6, 0.0, 4.2)).cut(slot)


def cut_torus():
    block = cq.Workplane().box(5, 5, 5).translate((2.0, 3.0, 1.0))
    return cq.Workplane(cq.Solid.makeTorus(4.0, 1.4)).cut(block)


def torus_with_mates():
    """Where the torus leaves the block two of its edges run side by side and are cut together."""
    block = cq.Workplane().box(5, 5, 5).translate((1.715, 1.982, 1.888))
    return cq.Workplane(cq.Solid.makeTorus(4.002, 0.78)).cut(block)


@pytest.mark.parametrize("part", [cut_cone, cut_torus, torus_with_mates])
@pytest.mark.parametrize("fraction", [1 / 120, 1 / 300, 1 / 1000, 1 / 1050])
def test_edges_of_uneven_curvature_keep_to_the_chord(part, fraction):
    model = from_cadquery(part())
    chord = fraction * model.diagonal
    report = check(mesh(model, chord=chord))
    assert report.surface_deviation_max <= chord


def test_a_spline_part_is_refined_until_all_is_proved():
    """After each round others were not proved: five when it was given up."""
    circle = cq.Workplane().circle(6.61).workplane(offset=13.4)
    model = from_cadquery(circle.rect(4.9, 3.01).loft())
    report = check(mesh(model, Sizing(chord=model.diagonal / 1000, proof=True)))
    assert report.clean, report.problems
    assert report.proof.proved_share == 1.0 and report.proof.bound_max <= model.diagonal / 1000
