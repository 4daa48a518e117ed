"""surfmesh alone has neither OCP nor VTK: what needs them says in one line what to install."""

import os
import subprocess
import sys

import pytest

ABSENT = ("OCP", "cadquery", "pyvista", "vtkmodules", "matplotlib", "meshio", "tetgen")


@pytest.fixture
def without_extras(tmp_path):
    """Run a program where no extra is installed; its output."""
    absent = tmp_path / "absent"
    absent.mkdir()
    for name in ABSENT:
        text = f"raise ModuleNotFoundError(\"No module named '{name}'\", name='{name}')\n"
        (absent / f"{name}.py").write_text(text)

    def run(program):
        path = os.pathsep.join([str(absent), *filter(None, sys.path)])
        done = subprocess.run(
            [sys.executable, "-c", program],
            env=os.environ | {"PYTHONPATH": path},
            cwd=tmp_path,
            capture_output=True,
            text=True,
        )
        assert done.returncode == 0, done.stderr
        return done.stdout

    return run


def test_formulas_and_planar_domains_need_no_extra(without_extras):
    program = """
import surfmesh as sm
from surfmesh.io import read
mesh = sm.mesh(sm.load("torus"), sm.Sizing(size=0.5))
mesh.save("torus.vtu")
assert read("torus.vtu").points.shape == mesh.points.shape and mesh.report.clean
square = sm.PlanarDomain([(0, 0), (1, 0), (1, 1), (0, 1)])
print(len(sm.mesh(square, sm.Sizing(size=0.2)).triangles) > 20)
"""
    assert without_extras(program) == "True\n"


@pytest.mark.parametrize(
    "extra, what",
    [
        ("cad", 'open("part.step", "w").write("ISO-10303-21;"); sm.load("part.step")'),
        ("view", 'mesh.plot("torus.png")'),
        ("view", "mesh.to_pyvista()"),
        ("view", "sm.check(mesh, second_opinion=True)"),
    ],
)
def test_what_is_missing_is_named_in_one_line(without_extras, extra, what):
    program = f"""
import surfmesh as sm
from surfmesh.errors import SurfmeshError
mesh = sm.mesh(sm.load("torus"), sm.Sizing(size=0.8))
try:
    {what}
except SurfmeshError as error:
    print(error)
"""
    said = without_extras(program)
    assert f"pip install 'surfmesh[{extra}]'" in said and said.count("\n") == 1
