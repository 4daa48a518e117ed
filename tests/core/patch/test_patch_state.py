"""What stops the optimiser, and what it refuses."""

import numpy as np
import pytest
from stages import patch_state, recovered

from surfmesh._core import patch as core
from surfmesh._core.surfaces import CallbackSurface
from surfmesh._core.triangulation import Triangulation
from surfmesh.geometry.differential.sides import find_sides
from surfmesh.loading import load
from surfmesh.meshing.boundary.boundary_loops import boundary_loops
from surfmesh.meshing.patch.packing import packed_over
from surfmesh.sizing.field.size_field import size_field
from surfmesh.sizing.options.sizing import Sizing


class Stop(Exception):
    """Raised by a test."""


class Breaking:
    """A surface of Python whose evaluation fails after some calls."""

    loops, name = (), "breaking"

    def __init__(self, surface, calls):
        self.surface, self.calls, self.domain = surface, calls, surface.domain

    def evaluate(self, uv, order=0):
        self.calls -= 1
        if self.calls < 0:
            raise Stop
        return self.surface.evaluate(uv, order)

    def derivative_bounds(self, lo, hi):
        return None


def prepared():
    surface = load("torus")
    sides = find_sides(surface)
    field = size_field(surface, Sizing(chord=0.02), sides)
    packing = packed_over(field, field.chart)
    loops = boundary_loops(surface, sides, field)
    return surface, field, recovered(packing.t, loops, field, surface)


def arguments(surface, field, domain, **changed):
    given = dict(
        t=domain.t, node=domain.node, same=domain.same, on_kinks=domain.on_kinks, points=None,
        surface=CallbackSurface(surface), chart=field.chart.core, background=field.background,
        chord=0.02,
    )  # fmt: skip
    return given | changed


@pytest.mark.parametrize("passes", [0, 1, 5])
def test_what_is_raised_before_a_pass_stops_the_work_and_comes_through(passes):
    surface, field, domain = prepared()
    calls = []

    def before_pass():
        calls.append(1)
        if len(calls) > passes:
            raise Stop

    state = patch_state(domain, surface, field.chart, field, before_pass)
    with pytest.raises(Stop):
        state.optimise()
    assert len(calls) == passes + 1 and state.passes == passes


@pytest.mark.parametrize("calls", [0, 1, 3, 20])
def test_what_a_surface_raises_comes_through(calls):
    surface, field, domain = prepared()
    with pytest.raises(Stop):
        breaking = Breaking(surface, calls)
        core.PatchState(**arguments(breaking, field, domain)).optimise()


def test_a_surface_that_does_not_break_gives_the_same_triangles():
    triangles = []
    for wrapped in (False, True):
        surface, field, domain = prepared()
        used = Breaking(surface, 10**9) if wrapped else surface
        core.PatchState(**arguments(used, field, domain)).optimise()
        triangles.append(domain.t.tri.copy())
    assert (triangles[0] == triangles[1]).all()


@pytest.mark.parametrize(
    "changed",
    [
        dict(node=np.array([-1], np.int32), same=np.array([0], np.int32)),
        dict(node=np.array([10**6], np.int32), same=np.array([0], np.int32)),
        dict(same=np.empty(0, np.int32)),
        dict(on_kinks=np.array([10**6], np.int32)),
        dict(points=np.zeros((1, 3))),
    ],
)
def test_what_is_no_patch_is_refused(changed):
    surface, field, domain = prepared()
    with pytest.raises(ValueError):
        core.PatchState(**arguments(surface, field, domain, **changed))


def test_a_triangulation_of_the_plane_is_no_domain():
    surface, field, domain = prepared()
    plane = packed_over(field, field.chart).t
    with pytest.raises(ValueError):
        core.PatchState(**arguments(surface, field, domain, t=plane))
    assert isinstance(plane, Triangulation)


def test_findings_of_another_patch_are_refused():
    surface, field, domain = prepared()
    state = core.PatchState(**arguments(surface, field, domain))
    left = state.optimise()
    assert len(left.far) == 0
    with pytest.raises(ValueError):
        state.size_requests(left, np.zeros(3, np.uint8))
    with pytest.raises(ValueError):
        state.split_farthest(np.array([10**6], np.int32))


def test_no_pass_comes_after_the_mapping():
    """What passes need is freed there; the domain and the scales of its sizes are kept."""
    surface, field, domain = prepared()
    state = patch_state(domain, surface, field.chart, field)
    nothing = np.empty(0, np.int32), np.empty((0, 2), np.int32), np.empty(0, np.int64)
    uv = np.zeros((int((domain.node >= 0).sum()), 2))
    mapped = state.mapped(uv, *nothing)
    assert len(mapped.points) == len(domain.t.xy) == len(state.frames.scale)
    for a_pass in (state.smooth, state.optimise, state.find_stars):
        with pytest.raises(ValueError, match="frames"):
            a_pass()
