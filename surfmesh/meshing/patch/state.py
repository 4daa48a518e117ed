"""The state of the optimiser on one patch, made in the core from what Python prepares."""

from collections.abc import Callable

import numpy as np

from surfmesh._core import patch as core
from surfmesh.geometry.core_surface import as_core_surface
from surfmesh.geometry.differential.chart import Chart
from surfmesh.geometry.surface import Surface
from surfmesh.meshing.boundary.boundary_recovery import DomainMesh
from surfmesh.sizing.field.size_field import SizeField


def patch_state(
    domain: DomainMesh,
    surface: Surface,
    chart: Chart,
    field: SizeField,
    before_pass: Callable[[], None] | None = None,
) -> core.PatchState:
    """One patch while it is optimised.

    before_pass: called before each pass of smoothing; may raise to stop the work.
    """
    used, sizing = domain.is_used, field.sizing
    return core.PatchState(
        domain.t, domain.node[used], domain.same[used],
        domain.on_kinks.astype(np.int32, copy=False),
        None if domain.points is None else domain.points[used],
        as_core_surface(surface), chart.core, field.background,
        sizing.chord, sizing.angle, sizing.min_size or 0.0, before_pass,
    )  # fmt: skip
