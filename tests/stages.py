"""The stages of a patch one by one, for tests that look in between."""

import numpy as np

from surfmesh._core import NIL
from surfmesh._core import insertion as core
from surfmesh._core import patch as core_patch
from surfmesh._core.insertion import Recovery
from surfmesh.geometry.core_surface import as_core_surface
from surfmesh.meshing.boundary.boundary_recovery import boundary_error


def recovered(t, loops, field, surface):
    """The domain inside loops that are inserted into the packing ``t``, which is used up."""
    nodes = field.chart.to_plane(loops.uv)
    found = core.recover(
        t, field.background, nodes, loops.segments, loops.inner, loops.identity, loops.points
    )
    if found.outcome.status != Recovery.FINISHED:
        segments = np.concatenate([loops.segments, loops.inner])
        raise boundary_error(found.outcome, loops.uv, segments, surface)
    return found.domain


def patch_state(domain, surface, chart, field, before_pass=None):
    """One patch while it is optimised; before_pass is called before each pass of smoothing."""
    used, sizing = domain.node != NIL, field.sizing
    return core_patch.PatchState(
        domain.t, domain.node[used], domain.same[used], domain.on_kinks,
        domain.points[used] if len(domain.points) else None,
        as_core_surface(surface), chart.core, field.background,
        sizing.chord, sizing.angle, sizing.min_size or 0.0, None, before_pass,
    )  # fmt: skip
