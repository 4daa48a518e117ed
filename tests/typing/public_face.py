"""The public face as a type checker sees it; checked by mypy, never run."""

from typing import assert_type

import numpy as np
from numpy.typing import NDArray

import surfmesh as sm
from surfmesh.geometry.surface import Surface


def saddle(u: np.ndarray, v: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    return u, v, u * u - v * v


surfaces: list[Surface] = [
    sm.ParametricSurface("u", "v", "u*v", u=(-1, 1), v=("0", "2*pi")),
    sm.NumericSurface(saddle, u=(-1, 1), v=(-1, 1), differences=6),
    sm.PlanarDomain([(0, 0), (1, 0), (1, 1)]),
]

mesh = sm.mesh(surfaces[0], sm.Sizing(chord=1e-3, size=lambda points: 0.1 + points[:, 0] ** 2))
assert_type(mesh, sm.SurfaceMesh)
assert_type(mesh.points, NDArray[np.float64])
assert_type(mesh.triangles, NDArray[np.int32])
assert_type(mesh.face_ids, NDArray[np.int32])
assert_type(mesh.uv, NDArray[np.float64] | None)
assert_type(mesh.surfaces, tuple[Surface, ...])
assert_type(mesh.sizing, sm.Sizing | None)
assert_type(mesh.edge_ids, NDArray[np.int32] | None)
assert_type(mesh.replaced(sizes=None, warnings=["one"]), sm.SurfaceMesh)
assert_type(sm.mesh(surfaces[1], 0.1), sm.SurfaceMesh)
assert_type(sm.mesh(surfaces[2], {"size": 0.1}), sm.SurfaceMesh)
report = sm.check(mesh)
assert_type(report, sm.Report)
assert_type(report.alpha_mean, float)
assert_type(report.deviation_max, float | None)
assert_type(report.shape.alpha_mean, float)
assert_type(report.problems, tuple[str, ...])
assert_type(sm.check(mesh).clean, bool)
assert_type(sm.pack(sm.UniformRadius(1, 2), count=10), sm.CirclePacking)
assert_type(sm.load("torus"), Surface | sm.CadModel)

said: list[tuple[str, float]] = []


def stop_early(stage: str, fraction: float) -> bool:
    return fraction < 0.5


sm.mesh(surfaces[0], progress=stop_early)
sm.mesh(surfaces[0], progress=lambda stage, fraction: said.append((stage, fraction)))
try:
    sm.mesh(surfaces[0], optimise="yes")  # type: ignore[arg-type]
except sm.errors.Cancelled as error:
    assert_type(error, sm.errors.Cancelled)
