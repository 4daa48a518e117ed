"""A triangle that is missing at a rim leaves nothing but free edges where the surface goes on."""

import cadquery as cq
import numpy as np
import pytest

import surfmesh as sm
from surfmesh.cli import main


def tube():
    return sm.from_cadquery(cq.Workplane().cylinder(2, 1).faces("not |Z"))


def pierced():
    corner = np.array([(0.3, 0.3), (0.6, 0.3), (0.6, 0.7), (0.3, 0.7)])
    return sm.ParametricSurface("u", "v", "u*v", u=(0, 1), v=(0, 1), loops=[corner])


SHEETS = {
    "tube": (tube, {"chord": 0.01}),
    "mobius": (lambda: sm.load("mobius"), {"chord": 0.02}),
    "pierced": (pierced, {"size": 0.1}),
    "saddle": (lambda: sm.ParametricSurface("u", "v", "u*v", u=(0, 1), v=(0, 2)), {"size": 0.2}),
}


@pytest.fixture(scope="module", params=SHEETS)
def sheet(request):
    make, sizes = SHEETS[request.param]
    return sm.mesh(make(), **sizes)


def at_rim(mesh):
    """A triangle with one free edge, whose far corner is inside."""
    edges = np.flatnonzero(mesh.connectivity.uses == 1)
    rim = np.unique(mesh.edges[edges])
    rows = mesh.connectivity.half_edges[edges, 0] // 3
    return next(k for k in rows if np.isin(mesh.triangles[k], rim).sum() == 2)


def without(mesh, triangles):
    return mesh.submesh(np.setdiff1d(np.arange(len(mesh.triangles)), triangles))


def test_a_whole_sheet_is_clean(sheet):
    assert sm.check(sheet).clean


def test_a_triangle_missing_at_a_rim_is_seen(sheet):
    torn = without(sheet, at_rim(sheet))
    said = " ".join(sm.check(torn).problems)
    assert "2 edges with nothing beside them where the surface goes on" in said


def test_it_is_seen_in_a_file_too(tmp_path):
    mesh = sm.mesh(sm.load("mobius"), chord=0.02)
    without(mesh, at_rim(mesh)).save(tmp_path / "torn.vtu")
    assert main(["check", str(tmp_path / "torn.vtu"), "--surface", "mobius"]) == 1


def test_a_part_of_a_surface_is_no_fault_where_nobody_says_that_it_is_whole():
    mesh = sm.mesh(sm.load("mobius"), chord=0.02)
    part = without(mesh, at_rim(mesh)).replaced(facts=None)
    assert sm.check(part).clean
