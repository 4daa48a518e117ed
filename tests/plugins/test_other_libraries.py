"""surfmesh from within PyVista and CadQuery, and models of programs."""

import cadquery as cq
import numpy as np
import pytest

import surfmesh as sm
from surfmesh.cli import main
from surfmesh.errors import CadError, FileFormatError
from surfmesh.plugins.script_models import model_of_script


def test_polydata_has_what_surfmesh_can_do(tmp_path):
    pyvista = pytest.importorskip("pyvista")
    if not hasattr(pyvista, "register_dataset_accessor"):
        pytest.skip("this PyVista has no accessors")
    import surfmesh.plugins.pyvista_accessor  # noqa: F401  as the entry point of an installation

    mesh = sm.mesh(cq.Workplane().box(1, 1, 1), 0.5)
    data = mesh.to_pyvista()
    assert data.surfmesh.check().clean
    np.testing.assert_array_equal(data.surfmesh.mesh.triangles, mesh.triangles)
    assert data.surfmesh.save(tmp_path / "box.stl").is_file()
    pytest.importorskip("tetgen")
    assert data.surfmesh.tetrahedralize().volume == pytest.approx(1.0, rel=1e-9)
    with pytest.raises(FileFormatError, match="triangulate"):
        _ = pyvista.Box().surfmesh.mesh


def test_a_workplane_meshes_itself():
    import surfmesh.plugins.cadquery_plugin  # noqa: F401  what it adds stays

    box = cq.Workplane().box(1, 1, 1)
    mesh = box.surfmesh(size=0.5)
    assert mesh.report.clean and len(mesh.surfaces) == 6
    assert len(box.val().surfmesh(0.5).triangles) == len(mesh.triangles)


BOX = "import cadquery as cq\n"


@pytest.mark.parametrize(
    "code",
    ["result = cq.Workplane().box(1, 1, 1)", "a = cq.Workplane().box(1, 1, 1)",
     "show_object(cq.Workplane().box(1, 1, 1), name='box')"],
)  # fmt: skip
def test_what_a_program_makes(code, tmp_path):
    path = tmp_path / "part.py"
    path.write_text(BOX + code)
    assert len(model_of_script(path).faces) == 6


@pytest.mark.parametrize(
    "code, said",
    [("a = 1", "leaves 0 objects"), ("1 / 0", "ZeroDivisionError: 'division by zero'")],
)
def test_a_program_that_makes_nothing(code, said, tmp_path):
    path = tmp_path / "part.py"
    path.write_text(BOX + code)
    with pytest.raises(CadError, match=said):
        model_of_script(path)


def test_a_program_runs_only_when_that_is_asked_for(tmp_path, capsys):
    path = tmp_path / "part.py"
    path.write_text(BOX + "result = cq.Workplane().box(1, 1, 1)")
    output = str(tmp_path / "part.vtu")
    assert main(["mesh", str(path), "-o", output, "--size", "0.5"]) == 2
    assert "--run-python" in capsys.readouterr().err and not (tmp_path / "part.vtu").exists()
    assert main(["mesh", str(path), "-o", output, "--size", "0.5", "--run-python"]) == 0
