"""The same mesh where numpy, BLAS and the C library take other code: that of an older processor."""

import hashlib
import os
import platform
import subprocess
import sys

import numpy as np
import pytest

MESHES = {
    **{"torus": 0.7, "two_peaks": 0.6, "sphere": 0.4, "dini": 0.6, "seashell": 0.6, "cone": 0.5},
    **{"enneper": 0.5, "wavy_sphere": 0.5, "hyperbolic_paraboloid": 0.3, "letter_a": 0.2},
}
OLDER = {
    "OPENBLAS_CORETYPE": "Nehalem",
    "GLIBC_TUNABLES": "glibc.cpu.hwcaps=-AVX2,-FMA,-AVX512F,-AVX2_Usable,-FMA_Usable",
}
HASHES = f"""
import hashlib
import surfmesh as sm
for name, size in {MESHES}.items():
    mesh = sm.mesh(sm.load(name), size)
    print(name, hashlib.sha256(mesh.points.tobytes() + mesh.triangles.tobytes()).hexdigest())
"""

OTHER_MESHES = """
import hashlib
import cadquery as cq
import surfmesh as sm
saddle = sm.ParametricSurface("u", "v", "u*u - v*v", (-1, 1.1), (-1.2, 1), name="saddle")
plane = sm.ParametricSurface("u", "v", "0", (-1.5, 1.515), (-1.5, 1.5), name="plane")
turns = (0, "2*pi"), (0, "pi")
ball = sm.ParametricSurface("sin(v)*cos(u)", "sin(v)*sin(u)", "cos(v)", *turns, name="ball")
loft = cq.Workplane().rect(4, 3).workplane(offset=5).circle(1).loft()
models = {
    "touch": (sm.intersect([saddle, plane]), {"size": 0.3}),
    "cross": (sm.intersect([ball, plane]), {"size": 0.4}),
    "balanced": (sm.load("torus"), {"chord": 0.02, "vertices": "balanced"}),
    "loft": (sm.from_cadquery(loft), {}),
    "stretched": (sm.from_cadquery(loft), {"chord": 0.01, "anisotropy": 5}),
}
for name, (model, sizes) in models.items():
    mesh = sm.mesh(model, **sizes)
    print(name, hashlib.sha256(mesh.points.tobytes() + mesh.triangles.tobytes()).hexdigest())
"""


def dispatched() -> str:
    """The features beyond its baseline that numpy uses on this processor."""
    from numpy._core import _multiarray_umath as umath

    found = umath.__cpu_features__
    return " ".join(feature for feature in umath.__cpu_dispatch__ if found.get(feature))


def hashes(environment: dict[str, str], script: str = HASHES) -> dict[str, str]:
    run = subprocess.run(
        [sys.executable, "-W", "ignore", "-c", script],
        env={**os.environ, **environment},
        capture_output=True,
        text=True,
        check=True,
        timeout=600,
    )
    return dict(line.split() for line in run.stdout.splitlines())


@pytest.mark.skipif(platform.machine() != "x86_64", reason="features of x86-64 are switched off")
def test_meshes_have_the_same_bytes_on_an_older_processor():
    here = hashes({})
    older = hashes({**OLDER, "NPY_DISABLE_CPU_FEATURES": dispatched()})
    assert len(here) == len(MESHES)
    assert older == here


@pytest.mark.skipif(platform.machine() != "x86_64", reason="features of x86-64 are switched off")
@pytest.mark.parametrize("processor", ["Nehalem", "Haswell", "SkylakeX"])
def test_models_are_the_same_whatever_blas_does(processor):
    here = hashes({}, OTHER_MESHES)
    assert len(here) == 5 and hashes({"OPENBLAS_CORETYPE": processor}, OTHER_MESHES) == here


@pytest.mark.skipif(platform.machine() != "x86_64", reason="features of x86-64 are switched off")
def test_the_processor_is_indeed_another_one():
    """numpy's own exponentials differ: the test above would notice."""
    if not dispatched():
        pytest.skip("numpy knows nothing beyond its baseline here")
    script = (
        "import hashlib, numpy as np; x = np.linspace(-9.0, 9.0, 9999);"
        "print(hashlib.sha256(np.exp(x).tobytes() + np.tan(x).tobytes()).hexdigest())"
    )
    x = np.linspace(-9.0, 9.0, 9999)
    here = hashlib.sha256(np.exp(x).tobytes() + np.tan(x).tobytes()).hexdigest()
    run = subprocess.run(
        [sys.executable, "-W", "ignore", "-c", script],
        env={**os.environ, **OLDER, "NPY_DISABLE_CPU_FEATURES": dispatched()},
        capture_output=True,
        text=True,
        check=True,
    )
    assert run.stdout.strip() != here
