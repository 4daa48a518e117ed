"""``import surfmesh`` is light, and the public names are what they should be."""

import subprocess
import sys

import cadquery as cq
import pytest

import surfmesh

HEAVY = ("numpy", "scipy", "sympy", "vtkmodules", "pyvista", "trimesh", "OCP", "rich")


def run(code):
    return subprocess.run(
        [sys.executable, "-c", code], capture_output=True, text=True, check=True
    ).stdout.strip()


@pytest.mark.parametrize("statement", ["import surfmesh", "import surfmesh.cli.arguments"])
def test_nothing_heavy_is_loaded(statement):
    assert run(f"import sys; {statement}; print([m for m in {HEAVY} if m in sys.modules])") == "[]"


def test_files_are_read_and_written_without_what_meshes_and_judges():
    code = (
        "import sys; import surfmesh.io; surfmesh.io.save; print('surfmesh._core' in sys.modules)"
    )
    assert run(code) == "False"


@pytest.mark.parametrize(
    ("what", "not_needed"),
    [
        ("sm.ParametricSurface('u', 'v', 'u * v', u=(0, 1), v=(0, 1))",
         "scipy.interpolate scipy.optimize scipy.special OCP surfmesh.cad.parts"),
        ("sm.PlanarDomain([(0, 0), (1, 0), (1, 1)])",
         "scipy.interpolate scipy.optimize sympy OCP surfmesh.cad.parts"),
    ],
)  # fmt: skip
def test_a_mesh_imports_what_its_surface_needs(what, not_needed):
    code = f"import sys, surfmesh as sm; sm.mesh({what}, 0.5)\n"
    code += f"print([m for m in {not_needed.split()} if m in sys.modules])"
    assert run(code) == "[]"


def test_sheets_are_read_meshed_and_judged_without_scipy(tmp_path):
    sides = cq.Workplane().box(1, 1, 1).faces(">Z or >X").vals()
    cq.exporters.export(cq.Workplane(cq.Compound.makeCompound(sides)), str(tmp_path / "open.step"))
    code = f"import sys, surfmesh as sm; model = sm.load({str(tmp_path / 'open.step')!r})\n"
    code += "print(len(sm.check(sm.mesh(model, 0.3)).problems), 'scipy' in sys.modules)"
    assert run(code) == "0 False"


def test_p_curves_are_made_anew_without_scipy():
    code = "import sys, numpy as np, surfmesh.cad.model.pcurves as pcurves\n"
    code += "pcurves.spline_through_points(np.arange(5.0), np.ones((5, 2)), 3)\n"
    assert run(code + "print('scipy' in sys.modules)") == "False"


def test_a_mesh_and_its_report_need_no_viewer():
    heavy = run(
        "import sys; import surfmesh as sm; sm.SurfaceMesh, sm.check, sm.Sizing; "
        "print([m for m in ('vtkmodules', 'trimesh', 'matplotlib', 'rich') if m in sys.modules])"
    )
    assert heavy == "[]"


@pytest.mark.parametrize(
    "first", ["", "import surfmesh.result.surface_mesh, surfmesh.quality, surfmesh.api", "sm.mesh"]
)
def test_verbs_are_functions_whatever_was_imported_before(first):
    code = f"import surfmesh as sm\n{first}\n"
    code += "import surfmesh.quality, surfmesh.api, surfmesh.io, surfmesh.view, surfmesh.cli\n"
    code += "print([type(getattr(sm, n)).__name__ for n in ('mesh', 'check', 'load', 'gallery')])"
    assert run(code) == str(["function"] * 4)


def test_every_public_name_is_there():
    for name in surfmesh.__all__:
        assert getattr(surfmesh, name) is not None
    assert set(surfmesh.__all__) <= set(dir(surfmesh))
    with pytest.raises(AttributeError, match="no attribute 'nonsense'"):
        _ = surfmesh.nonsense


def test_no_submodule_is_called_like_a_verb():
    from pathlib import Path

    modules = {path.stem for path in Path(surfmesh.__file__).parent.iterdir()}
    assert not modules & {"mesh", "check", "load", "gallery", "pack", "show"}
