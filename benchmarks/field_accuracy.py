"""The interpolated size tensor against the exact one, where gradation lets the curvature decide.

Exact: I(u, v) from the derivatives, h from the principal curvatures, both at the point itself.
Gradation only lowers sizes, by the slope that ``growth`` allows. A point is compared when no
other point could lower its size, even in a straight line through space: h(p) <= h(q) + slope
|p - q| for all q of a cloud as dense as the mesh itself, and of rings about p. Nor is a point
compared within about an edge of a pole: where its circle is over a sixth of the domain wide.
The error is the largest relative one over all directions: of the generalised eigenvalues of the
two metrics.
"""

import numpy as np
from measures import field_of
from target_count import sizing_for

import surfmesh as sm
from surfmesh.geometry.differential.fundamental_forms import curvatures, forms_from_derivatives
from surfmesh.geometry.parameter_grid import parameter_grid
from surfmesh.geometry.surface import Surface
from surfmesh.sizing.field.size_law import SizeLaw
from surfmesh.sizing.options.defaults import DEFAULT_ANGLE, DEFAULT_MAX_SIZE, LEAST_OF_CHORD
from surfmesh.sizing.rules.curvature_size import angle_size, chord_size, lattice_chord_size

POINTS = 10_000
CLOUD_TRIANGLES = 10_000
BLOCK = 500
WIDEST = 1.0 / 6.0  # of the domain: circles wider than this are at a pole
SPOKES = 24
RINGS = (0.001, 0.01, 0.05, 0.1, 0.2, 0.4, 0.6, 0.8, 1.0, 1.25, 1.5, 1.75, 2.0, 2.5, 3.0, 4.0)
"""Edge lengths from a point at which it is looked whether gradation comes from there."""

BUMP = "bump of width 1/1000"


def bump() -> Surface:
    """A gentle surface on a domain 2 wide with a bump 0.002 wide, off every regular grid."""
    return sm.ParametricSurface(
        "u",
        "v",
        "0.2*sin(2*u)*cos(v) + a*exp(-((u - 0.3177)**2 + (v + 0.2291)**2) / w**2)",
        u=(-1, 1),
        v=(-1, 1),
        parameters={"a": 2e-4, "w": 1e-3},
        name=BUMP,
    )


def field_accuracy(surface: Surface, growth: float, seed: int = 7) -> dict:
    """{"largest", "p999", "compared", "sampled", "uv" of the largest} of one surface.

    Half of the points are random in (u, v), half random in random triangles of a mesh, which
    is where the sizes are small.
    """
    random = np.random.default_rng(seed)
    sizing = sizing_for(surface, CLOUD_TRIANGLES, growth, tolerance=0.3)
    if "chord" not in sizing:
        return {"error": "the size is uniform"}
    field = field_of(surface, sizing)
    mesh = sm.mesh(surface, sm.Sizing(**sizing))
    lo, hi = np.array(surface.domain).T
    corners = mesh.uv[random.integers(0, len(mesh.triangles), POINTS // 2)]
    weights = random.dirichlet(np.ones(3), len(corners))
    uv = np.concatenate(
        [
            lo + random.random((POINTS // 2, 2)) * (hi - lo),
            np.einsum("nk,nki->ni", weights, corners),
        ]
    )
    size, metric, point, regular = _exact(surface, uv, sizing)
    cloud_uv = np.concatenate([mesh.uv_points, uv])
    cloud_size, _, cloud_point, cloud_regular = _exact(surface, cloud_uv, sizing)
    cloud_size = np.where(cloud_regular, cloud_size, _coarsest(surface))
    decided = np.flatnonzero(regular)
    decided = decided[
        _undisturbed(
            point[decided], size[decided], cloud_point, cloud_size, sm.Sizing(**sizing).gradient
        )
    ]
    decided = decided[
        _steady(surface, uv[decided], point[decided], size[decided], metric[decided], sizing)
    ]
    if not len(decided):
        return {"error": "gradation decides everywhere"}
    error = _errors(field, uv[decided], metric[decided])
    return {
        "largest": float(error.max()),
        "p999": float(np.quantile(error, 0.999)),
        "median": float(np.median(error)),
        "compared": len(decided),
        "sampled": len(uv),
        "uv": [float(value) for value in uv[decided[error.argmax()]]],
        "sizing": sizing,
    }


def _exact(surface: Surface, uv: np.ndarray, sizing: dict) -> tuple[np.ndarray, ...]:
    """Size (n,), metric E, F, G over h^2 (n, 3), point (n, 3), whether it is regular (n,)."""
    point, *derivatives = surface.evaluate(uv, 2)
    forms = forms_from_derivatives(*derivatives)
    k = curvatures(forms)
    on_lattice = SizeLaw.of(surface, sm.Sizing(**sizing)).is_on_lattice
    with np.errstate(all="ignore"):
        allowed = lattice_chord_size if on_lattice else chord_size
        by_chord = allowed(k.k1, k.k2, sizing["chord"])
        by_angle = angle_size(k.k1, k.k2, sizing.get("angle", DEFAULT_ANGLE))
        if "angle" not in sizing:
            by_angle = np.maximum(by_angle, LEAST_OF_CHORD * sizing["chord"])
        size = np.minimum(np.minimum(by_chord, by_angle), _coarsest(surface))
        metric = np.stack([forms.E, forms.F, forms.G], axis=1) / size[:, None] ** 2
    return size, metric, point, ~forms.degenerate & np.isfinite(size)


def _coarsest(surface: Surface) -> float:
    """The largest size when no ``max_size`` is asked for."""
    (points,) = surface.evaluate(parameter_grid(surface.domain, 17), 0)
    return DEFAULT_MAX_SIZE * float(np.linalg.norm(np.ptp(points, axis=0)))


def _undisturbed(point, size, cloud_point, cloud_size, slope) -> np.ndarray:
    """(n,) bool: no point of the cloud could lower the size by gradation."""
    from scipy.spatial.distance import cdist

    found = np.empty(len(point), bool)
    for start in range(0, len(point), BLOCK):
        block = slice(start, start + BLOCK)
        reach = cdist(point[block], cloud_point) * slope + cloud_size
        found[block] = size[block] <= reach.min(axis=1) * (1.0 + 1e-9)
    return found


def _steady(surface, uv, point, size, metric, sizing) -> np.ndarray:
    """(n,) bool: nor could any point of the rings of ``RINGS`` edge lengths."""
    slope = sm.Sizing(**sizing).gradient
    lo, hi = np.array(surface.domain).T
    # columns of M^(-1/2) up to a rotation: steps of metric length one
    step = np.linalg.inv(np.linalg.cholesky(metric[:, [[0, 1], [1, 2]]])).transpose(0, 2, 1)
    steady = np.ones(len(uv), bool)
    for angle in 2.0 * np.pi * np.arange(SPOKES) / SPOKES:
        for ring in RINGS:
            near = np.clip(uv + ring * step @ np.array([np.cos(angle), np.sin(angle)]), lo, hi)
            near_size, _, near_point, regular = _exact(surface, near, sizing)
            reach = near_size + slope * np.linalg.norm(near_point - point, axis=1)
            steady &= ~regular | (size <= reach * (1.0 + 1e-9))
    return steady


def _errors(field, uv: np.ndarray, metric: np.ndarray) -> np.ndarray:
    """Largest relative error over all directions of the length that counts as one."""
    xy = np.ascontiguousarray(field.chart.to_plane(uv))
    rates = field.chart.rates(xy)
    h = field.tensors(xy)
    a = np.linalg.inv(h[:, [[0, 1], [1, 2]]])
    found = a @ a  # M = H^-2 in the scaled plane
    exact = metric[:, [[0, 1], [1, 2]]] * rates[:, :, None] * rates[:, None, :]
    fits = 1.0 / np.sqrt(np.linalg.eigvalsh(exact)[:, 0]) < WIDEST * field.chart.extent.max()
    exact, found = exact[fits], found[fits]
    ratio = np.linalg.eigvals(np.linalg.solve(exact, found)).real
    error = np.zeros(len(uv))
    error[fits] = np.abs(1.0 / np.sqrt(ratio) - 1.0).max(axis=1)
    return error
