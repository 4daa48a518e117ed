"""What is wrong with a boundary that cannot be inserted into a packing (section 3).

All steps run in the core; what its status says is put into words here.
"""

import numpy as np

from surfmesh._core.insertion import BoundaryOutcome, Recovery
from surfmesh.errors import DomainError, MeshingError, SurfaceError, SurfmeshError
from surfmesh.geometry.surface import Surface


def boundary_error(
    outcome: BoundaryOutcome, uv: np.ndarray, segments: np.ndarray, surface: Surface
) -> SurfmeshError:
    """What the status means; ``where`` of the error is the place in (u, v).

    uv: (k, 2) of the nodes. segments: (s, 2) pairs of them, in the order of their insertion.
    """
    status, number = outcome.status, outcome.number
    error: SurfmeshError
    if status == Recovery.NODE_TAKEN:
        u, v = uv[number]
        error = SurfaceError(
            f"the boundary of {surface.name!r} touches itself at (u, v) = ({u:.6g}, {v:.6g})"
        )
        error.where = uv[number]
    elif status == Recovery.LEAK:
        error = SurfaceError(f"the boundary loops of {surface.name!r} do not enclose a domain")
        error.where = uv
    elif status == Recovery.LOST:
        error = MeshingError(f"the boundary of {surface.name!r} was lost: please report this")
    elif status == Recovery.DIFFERENT_LOOPS:
        error = DomainError(f"region {number} lies in different loops by different ways")
    elif status == Recovery.UNREACHABLE_REGION:
        error = DomainError(f"region {number} cannot be reached from the infinite one")
    elif status == Recovery.NOTHING_INSIDE:
        error = DomainError(f"no part of {surface.name!r} is inside: the holes cover all of it")
    else:
        error = _segment_error(status, uv[segments[number]], surface)
    return error


def _segment_error(status: Recovery, ends: np.ndarray, surface: Surface) -> SurfmeshError:
    """Of the segment with these ends (2, 2) in (u, v)."""
    a, b = ends
    line = f"({a[0]:.6g}, {a[1]:.6g}) - ({b[0]:.6g}, {b[1]:.6g})"
    error: SurfmeshError
    if status in (Recovery.CROSSING, Recovery.SEGMENT_ON_NODE):
        verb = "crosses itself" if status == Recovery.CROSSING else "touches itself"
        error = SurfaceError(f"the boundary of {surface.name!r} {verb} on (u, v) {line}")
    else:
        error = MeshingError(
            f"the boundary segment {line} of {surface.name!r} could not be recovered"
        )
    error.where = ends
    return error
