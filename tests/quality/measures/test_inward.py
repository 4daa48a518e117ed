"""A closed surface that faces its inside is said to, and one call turns it over."""

import cadquery as cq
import numpy as np
import pytest
from handmade_meshes import changed, icosphere

import surfmesh as sm
from surfmesh.cli import main
from surfmesh.io import read
from surfmesh.result.surface_mesh import SurfaceMesh


def sphere(inward):
    first, second = ("sin(v)*cos(u)", "sin(v)*sin(u)")
    x, y = (first, second) if inward else (second, first)
    facts = {"volume": 4 * np.pi / 3}
    return sm.ParametricSurface(x, y, "cos(v)", u=(0, "2*pi"), v=(0, "pi"), facts=facts)


@pytest.mark.parametrize("sizing", [0.4, sm.Sizing(chord=0.02, anisotropy=4)])
def test_an_inward_sphere_is_said_and_turned(sizing):
    mesh = sm.mesh(sphere(inward=True), sizing)
    report = mesh.report
    assert report.clean and report.volume < 0 and report.volume_error == pytest.approx(0, abs=0.1)
    assert len(report.warnings) == 1 and "mesh.flipped() (--flip)" in report.warnings[0]
    turned = mesh.flipped().report
    assert turned.clean and not turned.warnings and turned.volume == pytest.approx(-report.volume)
    assert turned.inverted == turned.folded == 0
    assert not sm.mesh(sphere(inward=False), sizing).report.warnings


@pytest.mark.parametrize("order", [1, 2])
def test_turned_twice_is_the_same(order):
    solids = [cq.Solid.makeBox(1, 1, 1), cq.Solid.makeBox(1, 1, 1, cq.Vector(2, 0, 0))]
    for mesh in (
        sm.mesh(sphere(True), 0.5, order=order),
        sm.mesh(sm.from_cadquery(solids), 0.5, order=order),
        changed(icosphere(1), surfaces=()),
    ):
        once = mesh.flipped()
        assert np.array_equal(once.nodes, mesh.nodes) and once.order == mesh.order
        assert np.array_equal(once.edges, mesh.edges)
        normals = [np.cross(*(m.points[m.triangles[:, k]] for k in (1, 2))) for m in (mesh, once)]
        assert np.allclose(normals[0], -normals[1])
        twice = once.flipped()
        for name in mesh.__dataclass_fields__:
            first, second = getattr(mesh, name), getattr(twice, name)
            assert np.array_equal(first, second) if isinstance(first, np.ndarray) else True, name
            assert (first is None) == (second is None), name


def test_quadratic_elements_stay_on_their_edges():
    mesh = sm.mesh(sphere(True), 0.5, order=2).flipped()
    corners, middles = mesh.nodes[mesh.elements[:, :3]], mesh.nodes[mesh.elements[:, 3:]]
    straight = (corners + np.roll(corners, -1, axis=1)) / 2
    length = np.linalg.norm(corners - np.roll(corners, -1, axis=1), axis=2)
    assert (np.linalg.norm(middles - straight, axis=2) < 0.2 * length).all()


def test_a_void_faces_rightly():
    outer, inner = icosphere(1), icosphere(1)

    def together(inner_triangles, shift):
        return SurfaceMesh(
            points=np.concatenate([3 * outer.points, inner.points + (shift, 0, 0)]),
            triangles=np.concatenate([outer.triangles, inner_triangles + len(outer.points)]),
        )

    assert not together(inner.triangles[:, ::-1], 0).report.warnings  # a void
    apart = together(inner.triangles[:, ::-1], 9).report.warnings
    assert len(apart) == 1 and "1 of 2 closed pieces faces the inside" in apart[0]


def test_a_turned_model_keeps_its_figures():
    mesh = sm.mesh(cq.Workplane().box(2, 2, 2).faces(">Z").workplane().hole(1), 0.4)
    turned = mesh.flipped().report
    assert turned.folded == 0 and turned.clean
    assert turned.by_solid[0].volume == pytest.approx(mesh.report.by_solid[0].volume)


def test_the_command_turns_it(tmp_path, capsys):
    formulas = ["--x", "sin(v)*cos(u)", "--y", "sin(v)*sin(u)", "--z", "cos(v)"]
    domain = ["--u", "0", "2*pi", "--v", "0", "pi", "--size", "0.5"]
    out = str(tmp_path / "ball.vtu")
    assert main(["mesh", *formulas, *domain, "-o", out]) == 0
    assert "--flip" in capsys.readouterr().out
    assert main(["mesh", *formulas, *domain, "-o", out, "--flip"]) == 0
    assert "--flip" not in capsys.readouterr().out
    assert read(out).report.volume > 3
    surface = tmp_path / "ball.toml"
    surface.write_text(
        'name = "ball"\nx = "sin(v)*cos(u)"\ny = "sin(v)*sin(u)"\nz = "cos(v)"\n'
        '[domain]\nu = [0, "2*pi"]\nv = [0, "pi"]\n'
    )
    assert main(["check", out, "--surface", str(surface)]) == 0, capsys.readouterr().out
