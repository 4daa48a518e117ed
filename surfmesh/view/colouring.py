"""What a mesh can be coloured by: the values, their name with unit, map and limits."""

from contextlib import suppress
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from surfmesh.errors import did_you_mean, shown
from surfmesh.geometry.differential.fundamental_forms import PrincipalCurvatures, curvatures, forms
from surfmesh.quality.measures.measurements import Measurements
from surfmesh.quality.measures.shape import shapes
from surfmesh.result.surface_mesh import SurfaceMesh
from surfmesh.view.legend import unit_of
from surfmesh.view.vertex_parameters import vertex_parameters

ROBUST = 0.995  # fraction of the values within the limits where a few would swallow the scale
SIGNED_ROBUST = 0.95  # the same where both signs occur and no logarithm can help

NARROW = 1.2  # ratio of the limits that no scale falls short of
WIDE = 20.0  # ratio of the limits above which the scale is logarithmic
DECADES = 1e3  # no scale spans more
HUES = 20  # faces that have a colour of their own; then colours come again


@dataclass(frozen=True)
class Colouring:
    """Values to show; one a vertex or one a triangle."""

    values: NDArray
    title: str  # of the colour bar, with unit
    colours: str  # name of a matplotlib colour map
    limits: tuple[float, float]
    per_vertex: bool = False
    logarithmic: bool = False
    hues: int = 0  # values are whole numbers with a colour each; 0: a continuous scale

    @property
    def within(self) -> NDArray:
        """The values, those below a logarithmic scale (zero may be one) lifted onto it."""
        return np.maximum(self.values, self.limits[0]) if self.logarithmic else self.values


def colouring(mesh: SurfaceMesh, by: str) -> Colouring:
    """Values of ``mesh`` by name, one of ``COLOURS``.

    Raises ``ValueError`` for another name, or when the mesh does not carry what it takes.
    """
    if by in _COLOURINGS:
        return _COLOURINGS[by](mesh)
    if by not in _CURVATURES:
        raise ValueError(unknown_colouring(by))
    found = _vertex_curvatures(mesh)
    if found is None:
        raise ValueError(f"cannot colour by {by!r}: the mesh carries no surface")
    return _CURVATURES[by](mesh, found)


def unknown_colouring(by: object) -> str:
    known = ", ".join(COLOURS)
    return f"cannot colour by {shown(by)}; known are {known}{did_you_mean(str(by), COLOURS)}"


def colourings_of(mesh: SurfaceMesh) -> dict[str, Colouring]:
    """Everything in ``LABELS`` that ``mesh`` carries the data for."""
    found = {}
    for by in LABELS:
        if by in _COLOURINGS:
            with suppress(ValueError):
                found[by] = colouring(mesh, by)
    bent = _vertex_curvatures(mesh)
    if bent is not None:
        found |= {by: make(mesh, bent) for by, make in _CURVATURES.items()}
    return found


def _by_alpha(mesh: SurfaceMesh) -> Colouring:
    values = shapes(mesh).alpha
    worst = min(0.8, np.floor(10 * float(values.min(initial=1.0))) / 10)
    return Colouring(values, "shape alpha (1 = equilateral)", "viridis", (worst, 1.0))


def _by_angle(mesh: SurfaceMesh) -> Colouring:
    values = shapes(mesh).min_angle
    limits = (min(30.0, 10 * np.floor(float(values.min(initial=60.0)) / 10)), 60.0)
    return Colouring(values, "smallest angle (degrees)", "viridis", limits)


def _by_size(mesh: SurfaceMesh) -> Colouring:
    if mesh.sizes is None:
        raise ValueError("cannot colour by 'size': the mesh carries no wanted sizes")
    return _positive(mesh.sizes, f"wanted edge length ({unit_of(mesh)})", "viridis")


def _by_deviation(mesh: SurfaceMesh) -> Colouring:
    found = Measurements(mesh).deviation
    if found is None:
        raise ValueError("cannot colour by 'deviation': the mesh carries no surface")
    round_off = 1e-12 * float(np.abs(mesh.points).max(initial=1e-300))  # flat faces: no scale
    limits = (0.0, max(found.largest, round_off))
    title = f"distance from the surface ({unit_of(mesh)})"
    return Colouring(found.by_triangle, title, "magma_r", limits)


def _by_face(mesh: SurfaceMesh) -> Colouring:
    count = int(mesh.face_ids.max(initial=0)) + 1
    hues = min(count, HUES)
    title = "face number" if count <= HUES else f"face number modulo {HUES}"
    return Colouring(mesh.face_ids % HUES, title, "tab20", (-0.5, hues - 0.5), hues=hues)


def _by_curvature(mesh: SurfaceMesh, found: PrincipalCurvatures) -> Colouring:
    values = np.maximum(np.abs(found.k1), np.abs(found.k2))
    return _positive(values, f"largest principal curvature (1 / {unit_of(mesh, 1)})", "viridis")


def _by_gaussian(mesh: SurfaceMesh, found: PrincipalCurvatures) -> Colouring:
    return _signed(found.gaussian, f"Gaussian curvature K (1 / {unit_of(mesh, 1)}²)")


def _by_mean_curvature(mesh: SurfaceMesh, found: PrincipalCurvatures) -> Colouring:
    return _signed(found.mean, f"mean curvature H (1 / {unit_of(mesh, 1)})")


def _vertex_curvatures(mesh: SurfaceMesh) -> PrincipalCurvatures | None:
    """Curvatures at the vertices of ``mesh``, each on one of its faces.

    Normals are those of the triangles: where a face is turned over, so are the signs, and convex
    fillets of a solid have all one sign.
    """
    place = vertex_parameters(mesh)
    if place is None:
        return None
    n = len(mesh.points)
    whole = PrincipalCurvatures(*(np.zeros(s) for s in (n, n, (n, 2), (n, 2), n, n)))
    for number, surface in enumerate(mesh.surfaces):
        mine = place.face == number
        if mine.any():
            found = curvatures(forms(surface, place.uv[mine]))
            if mesh.turned_faces is not None and mesh.turned_faces[number]:
                found = PrincipalCurvatures(
                    -found.k2, -found.k1, found.d2, found.d1, found.gaussian, -found.mean
                )
            for values, part in zip(whole, found):
                values[mine] = part
    return whole


def _positive(values: NDArray, title: str, colours: str) -> Colouring:
    """Values a vertex, none negative; on a logarithmic scale when they span decades."""
    low, high = (float(value) for value in np.quantile(values, (1 - ROBUST, ROBUST)))
    logarithmic = high > WIDE * low and high > 0
    if logarithmic:
        low = max(low, high / DECADES)
    elif not high > NARROW * low:  # what is the same everywhere shall look so
        middle = 0.5 * (low + high) or 1.0
        low, high = 0.9 * middle, 1.1 * middle
    return Colouring(values, title, colours, (low, high), True, logarithmic)


def _signed(values: NDArray, title: str) -> Colouring:
    """Values a vertex on a scale with zero in its middle."""
    high = float(np.quantile(np.abs(values), SIGNED_ROBUST)) or 1.0
    return Colouring(values, title, "coolwarm", (-high, high), True)


_COLOURINGS = {
    "alpha": _by_alpha,
    "quality": _by_alpha,
    "angle": _by_angle,
    "size": _by_size,
    "deviation": _by_deviation,
    "face": _by_face,
}
_CURVATURES = {"curvature": _by_curvature, "gaussian": _by_gaussian, "mean": _by_mean_curvature}

CURVATURES = tuple(_CURVATURES)
"""Names of what may jump from face to face."""

COLOURS = (*_COLOURINGS, *_CURVATURES)
"""Names that ``colouring`` knows; "quality" is alpha."""

LABELS = {
    "alpha": "shape",
    "angle": "smallest angle",
    "size": "wanted size",
    "deviation": "distance from the surface",
    "face": "face",
    "curvature": "largest curvature",
    "gaussian": "Gaussian curvature",
    "mean": "mean curvature",
}
"""Their short names in menus."""
