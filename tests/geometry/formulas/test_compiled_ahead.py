"""Formulas of the gallery that are compiled ahead: what the compiler makes of them, no more."""

import subprocess
import sys

import numpy as np
import pytest

import surfmesh as sm
from surfmesh.geometry.files.formula_file import (
    gallery,
    gallery_folder,
    key_of_file,
    load_formula_file,
)
from surfmesh.geometry.formulas.compiled_ahead import CompiledFormulas, compiled_ahead


@pytest.mark.parametrize("path", gallery().values(), ids=gallery())
def test_the_file_is_what_the_compiler_makes(path):
    made = load_formula_file(path, ahead=False)
    known = compiled_ahead(gallery_folder(), key_of_file(path))
    cure = "run python tools/compile_gallery.py"
    assert known == made.compiled() == CompiledFormulas.of_plain(known.plain()), cure
    ready = load_formula_file(path)
    assert "_expressions" not in vars(ready) and "_expressions" in vars(made)
    assert repr(ready) == repr(made) and ready.bent_axes is not None
    uv = np.random.default_rng(0).uniform(*np.array(made.domain).T, (50, 2))
    for ours, theirs in zip(ready.evaluate(uv, 2), made.evaluate(uv, 2)):
        assert np.array_equal(ours, theirs, equal_nan=True)
    assert (ready.guides() is None) == (made.guides() is None)


def test_a_formula_that_was_changed_is_compiled_anew(tmp_path):
    text = gallery()["torus"].read_text()
    changed = tmp_path / "torus.toml"
    changed.write_text(text.replace("R = 3.0", "R = 4.0"))
    surface = sm.load(changed)
    assert surface.evaluate([[0.0, 0.0]])[0][0, 0] == 5.0
    changed.write_text(text.replace("R = 3.0", "R = 1e999"))
    with pytest.raises(sm.errors.SurfaceError, match="not finite"):
        sm.load(changed)
    changed.write_text("# the same\n" + text)
    assert "_expressions" not in vars(sm.load(changed))


def test_sympy_is_not_imported():
    code = "import sys, surfmesh as sm; sm.check(sm.mesh(sm.load('torus'))); " \
           "sys.exit('sympy' in sys.modules)"  # fmt: skip
    subprocess.run([sys.executable, "-c", code], check=True)
