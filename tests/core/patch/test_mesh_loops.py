"""A whole patch in one call of the core: its stages, what stops it, and what it refuses."""

import numpy as np
import pytest
from naive.background import constant_background
from naive.triangulation import check_domain

from surfmesh._core import patch as core
from surfmesh._core.insertion import Recovery
from surfmesh._core.patch import PatchEnd, PatchStage
from surfmesh._core.surfaces import plane
from surfmesh.geometry.differential.chart import Chart

X, Y = np.array([1.0, 0.0, 0.0]), np.array([0.0, 1.0, 0.0])
SURFACE = plane(((0.0, 1.0), (0.0, 1.0)), np.zeros(3), X, Y)
CHART = Chart.uniform(((0.0, 1.0), (0.0, 1.0)), (1.0, 1.0)).core
RING = np.array([[0, 1], [1, 2], [2, 3], [3, 0]], np.int32)
SQUARE = np.array([[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]])


class Stop(Exception):
    """Raised by a test."""


def mesh(uv=SQUARE, segments=RING, size=0.3, identity=None, **hooks):
    settings = core.PatchSettings(
        SURFACE, CHART, constant_background(size, 1.0, 1.0), box=(0, 0, 1, 1), expected=20, **hooks
    )
    nodes = np.arange(len(uv)) if identity is None else identity
    inner = np.empty((0, 2), np.int32)
    return core.mesh_loops(settings, uv, uv, segments, inner, nodes)


def test_a_square_is_filled_and_its_stages_are_told():
    told = []
    made = mesh(before_stage=told.append)
    assert made.end == PatchEnd.DONE and made.boundary.status == Recovery.FINISHED
    assert told == list(PatchStage)
    assert check_domain(made.domain.t, euler=1) is None
    corners = made.mapped.points[made.mapped.triangles]
    normals = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    assert 0.5 * normals[:, 2].sum() == pytest.approx(1.0) and (normals[:, 2] > 0.0).all()
    assert made.requests.chord is made.requests.folds is made.requests.angle is None


@pytest.mark.parametrize("stage", list(PatchStage))
def test_what_a_hook_raises_comes_through(stage):
    def refuse(begun):
        if begun == stage:
            raise Stop

    with pytest.raises(Stop):
        mesh(before_stage=refuse)


def test_what_is_raised_before_a_pass_comes_through():
    def refuse():
        raise Stop

    with pytest.raises(Stop):
        mesh(before_pass=refuse)


def test_a_boundary_that_crosses_itself_is_a_status_with_its_place():
    made = mesh(SQUARE[[0, 2, 1, 3]])
    assert made.end == PatchEnd.BOUNDARY_FAILED
    assert made.boundary.status == Recovery.CROSSING and made.boundary.number == 2


def test_what_would_leave_the_arrays_is_refused():
    with pytest.raises(ValueError, match="segments has an index"):
        mesh(segments=RING + 1)
    with pytest.raises(ValueError, match="identity"):
        mesh(identity=np.array([0, 1, 2, 4]))
    with pytest.raises(ValueError, match="not finite"):
        mesh(SQUARE * np.nan)
