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


def dispatched() -> str:
    """The features beyond its baseline that numpy uses on this processor."""
    from numpy._core import _multiarray_umath as umath

    found = umath.__cpu_features__
    return " ".join(feature for feature in umath.__cpu_dispatch__ if found.get(feature))


def hashes(environment: dict[str, str]) -> dict[str, str]:
    run = subprocess.run(
        [sys.executable, "-W", "ignore", "-c", HASHES],
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
