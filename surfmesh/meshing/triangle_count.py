"""Sizes for a wanted number of triangles: all are scaled by one factor until the mesh has it.

chord, max_size of the defaults, scaled
  estimate -> estimate -> mesh, and mesh again where its count is off      count ~ 1 / scale^2
"""

import math
from collections.abc import Callable, Iterator

from surfmesh.errors import SizingError
from surfmesh.result.surface_mesh import SurfaceMesh
from surfmesh.sizing.options.defaults import DEFAULT_CHORD, DEFAULT_MAX_SIZE, LONGEST
from surfmesh.sizing.options.sizing import Sizing

NEAR = 0.02
"""An estimate this near to what is wanted, relatively, is near enough: they are no nearer to the
mesh themselves."""

PROMISED = 0.05
"""So near the mesh comes, relatively, or says that it does not."""

AIMED = 0.6 * PROMISED
"""A mesh this near is not made again."""

ESTIMATES, MESHES = 8, 5
"""So many are made at most."""

LARGEST_STEP = 4.0
"""Factor on the scale of one step, at most."""

DEAF = -0.3
"""Where the count falls by a lesser power of the scale, something else decides it."""


def sizing_for_count(
    sizing: Sizing, diagonal: float, count: Callable[[Sizing], float]
) -> tuple[Sizing, float]:
    """The sizes that ``count`` says give ``sizing.triangles``, and their scale.

    diagonal: of the bounding box, model units. count: triangles that sizes would give.
    """
    wanted = _wanted(sizing)
    best, least = 1.0, math.inf
    for scale, found in _search(wanted, 1.0, lambda s: count(_scaled(sizing, diagonal, s))):
        off = abs(math.log(found / wanted))
        if off < least:
            best, least = scale, off
        if off < NEAR:
            break
    return _scaled(sizing, diagonal, best), best


def mesh_with_count(
    sizing: Sizing,
    diagonal: float,
    count: Callable[[Sizing], float],
    mesh: Callable[[Sizing], SurfaceMesh],
) -> SurfaceMesh:
    """The mesh that has ``sizing.triangles`` within 5 %, or as nearly as can be: it warns then.

    count: triangles that sizes would give, about. mesh: of these sizes.
    """
    wanted = _wanted(sizing)
    _, start = sizing_for_count(sizing, diagonal, count)
    meshes: list[SurfaceMesh] = []

    def made(scale: float) -> float:
        found = mesh(_scaled(sizing, diagonal, scale))
        meshes.append(found)
        meshes.sort(key=lambda one: _off(one, wanted))
        del meshes[1:]  # the nearest is kept
        return len(found.triangles)

    for trial, _ in enumerate(_search(wanted, start, made)):
        if _off(meshes[0], wanted) < math.log1p(AIMED) or trial + 1 == MESHES:
            break
    best = meshes[0]
    if _off(best, wanted) <= math.log1p(PROMISED):
        return best
    return best.with_warnings(
        f"{len(best.triangles):,} triangles, where {wanted:,} were asked for: boundaries, details "
        "and the other sizes asked for decide"
    )


def _wanted(sizing: Sizing) -> int:
    if sizing.triangles is None:
        raise SizingError("no number of triangles is asked for")
    return sizing.triangles


def _off(mesh: SurfaceMesh, wanted: int) -> float:
    """Logarithm of the ratio, without its sign."""
    return abs(math.log(max(len(mesh.triangles), 1) / wanted))


def _scaled(sizing: Sizing, diagonal: float, scale: float) -> Sizing:
    """The default sizes times ``scale``, within the other sizes asked for.

    The chord goes with the square: so all sizes that follow from it are scaled alike.
    """
    fraction = LONGEST if sizing.anisotropy > 1.0 else DEFAULT_MAX_SIZE
    largest = max(fraction * diagonal * scale, sizing.min_size or 0.0)
    return sizing.replaced(
        triangles=None,
        chord=DEFAULT_CHORD * diagonal * scale * scale,
        max_size=min(largest, sizing.max_size or math.inf),
    )


def _search(
    wanted: int, scale: float, count: Callable[[float], float]
) -> Iterator[tuple[float, float]]:
    """Scales and their counts by secants of the logarithms, until they no longer change."""
    power, before = -2.0, (0.0, 0.0)
    for trial in range(ESTIMATES):
        found = max(count(scale), 1.0)
        yield scale, found
        if trial:
            slope = math.log(found / before[1]) / math.log(scale / before[0])
            if slope > DEAF:
                return
            power = min(max(slope, -4.0), -1.0)
        before = scale, found
        step = (wanted / found) ** (1.0 / power)
        scale *= min(max(step, 1.0 / LARGEST_STEP), LARGEST_STEP)
