"""Upper bounds of the size, for another round, where the optimiser could not mend a patch."""

from typing import NamedTuple

from surfmesh._core import patch as core
from surfmesh.sizing.rules.size_limits import SizeLimits


class SizeRequests(NamedTuple):
    """What a patch asks for, by what is not right there; None for nothing."""

    chord: SizeLimits | None = None
    folds: SizeLimits | None = None
    angle: SizeLimits | None = None

    @classmethod
    def of(cls, found: core.SizeRequests, gradient: float) -> "SizeRequests":
        """From what the core found; ``gradient``: how fast the sizes may grow from there."""
        return cls(*(_limits(part, gradient) for part in (found.chord, found.folds, found.angle)))


def joined(*requests: SizeLimits | None) -> SizeLimits | None:
    """All of them, in their order; None where there is none."""
    found: SizeLimits | None = None
    for request in requests:
        if request is not None and len(request.sizes):
            found = request if found is None else found.joined_with(request)
    return found


def _limits(found: core.SizeLimitArrays | None, gradient: float) -> SizeLimits | None:
    if found is None:
        return None
    if not len(found.metric_root_3d):
        return SizeLimits(found.points, found.sizes, gradient)
    return SizeLimits(
        found.points, found.sizes, gradient, uv=found.uv, metric_root_3d=found.metric_root_3d
    )
