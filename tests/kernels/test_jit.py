"""The kernel decorator: stale caches, pure Python, bounds checks."""

import importlib.util
import os
import shutil
import subprocess
import sys
from pathlib import Path

import pytest

import surfmesh.kernels
from surfmesh.kernels import jit

KERNELS = Path(surfmesh.kernels.__file__).parent


def digest_of(folder):
    spec = importlib.util.spec_from_file_location("jit_copy", folder / "jit.py")
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module._digest()


def test_digest_sees_every_edit(tmp_path):
    folder = tmp_path / "kernels"
    shutil.copytree(KERNELS, folder, ignore=shutil.ignore_patterns("__pycache__"))
    before = digest_of(folder)
    assert before == digest_of(folder) == jit._digest()
    seen = {before}
    for source in sorted(folder.glob("*.py")):
        if source.name != "jit.py":
            source.write_text(source.read_text() + "\n# edited\n")
            seen.add(digest_of(folder))
    (folder / "another.py").write_text("")
    seen.add(digest_of(folder))
    (folder / "another.py").rename(folder / "renamed.py")
    seen.add(digest_of(folder))
    assert len(seen) == len(list(KERNELS.glob("*.py"))) - 1 + 3


def test_cache_folder_can_be_chosen(monkeypatch, tmp_path):
    monkeypatch.setenv("SURFMESH_CACHE_DIR", str(tmp_path))
    assert jit.cache_folder().parent == tmp_path
    assert jit.cache_folder().name.endswith(jit._DIGEST)


MESH = """
import numpy as np
import surfmesh as sm
from surfmesh.kernels.triangulation.predicates import orient
from surfmesh.meshing.patch.packing import packed
from surfmesh._core.fields import Background

field = Background(
    np.array([0.0, 0.0, 1.0, 1.0, 1e30]), np.array([1, 1]), np.array([-1], np.int32),
    np.arange(4, dtype=np.int32).reshape(1, 4), np.array([[5.0, 1.0, 4.0, 4.0]] * 4),
)
packing = packed(field, (0.0, 0.0, 1.0, 1.0), (0.5, 0.5), 30)
print("circles", [packing.t.vertices, packing.t.triangles], float(packing.t.xy.sum()))
{more}
print("compiled", hasattr(orient, "py_func"))
"""
WHOLE = """
surface = sm.ParametricSurface("u", "v", "u*v + 0.3*u**2", (0, 1), (0, 1))
mesh = sm.mesh(surface, 0.4)
print("mesh", len(mesh.points), float(mesh.points.sum()))
"""


def said(more, **environment):
    done = subprocess.run(
        [sys.executable, "-c", MESH.format(more=more)],
        env=os.environ | environment, capture_output=True, text=True, timeout=300,
    )  # fmt: skip
    assert done.returncode == 0, done.stderr
    return done.stdout.splitlines()


def test_pure_python_gives_the_same():
    compiled, plain = said(WHOLE), said(WHOLE, NUMBA_DISABLE_JIT="1")
    assert (compiled.pop(), plain.pop()) == ("compiled True", "compiled False")
    for first, second in zip(compiled, plain, strict=True):
        assert first.rsplit(" ", 1)[0] == second.rsplit(" ", 1)[0]
        assert float(first.rsplit(" ", 1)[1]) == pytest.approx(float(second.rsplit(" ", 1)[1]))


@pytest.mark.skipif(
    not os.environ.get("SURFMESH_SLOW"),
    reason="compiles all kernels once more, over a minute: SURFMESH_SLOW=1 runs it",
)
def test_no_index_is_out_of_bounds(tmp_path):
    with_bounds = said(WHOLE, NUMBA_BOUNDSCHECK="1", SURFMESH_CACHE_DIR=str(tmp_path))
    assert with_bounds[-1] == "compiled True"
    assert with_bounds == said(WHOLE)
