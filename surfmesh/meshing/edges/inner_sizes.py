"""What the sizes inside a face ask for along its edges, which know their own surroundings only."""

from surfmesh._core.faces import CoarseSegments
from surfmesh.sizing.options.sizing import Sizing
from surfmesh.sizing.rules.size_limits import SizeLimits, along_lines


def sizes_along_edges(sizing: Sizing, coarse: CoarseSegments) -> SizeLimits | None:
    """What the core has found: sizes at segments far longer than those inside allow."""
    sizes = coarse.sizes
    if not len(sizes):
        return None
    metric_root_3d = along_lines(coarse.along, sizes) if sizing.is_anisotropic else None
    return SizeLimits(coarse.points, sizes, sizing.gradient, metric_root_3d=metric_root_3d)
