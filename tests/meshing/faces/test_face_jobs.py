"""Jobs of faces that are made when they are wanted."""

import cadquery as cq
import pytest

import surfmesh as sm
from surfmesh.meshing.estimate.unmeshed_model import UnmeshedModel
from surfmesh.meshing.faces.face_jobs import FaceJobs
from surfmesh.meshing.faces.face_state import later_jobs


@pytest.fixture(scope="module")
def unmeshed():
    """A ball beside a plate with a countersunk hole: with poles, so with edges that are points."""
    plate = cq.Workplane().box(6, 4, 1).faces(">Z").workplane().cskHole(0.6, 1.4, 82)
    return UnmeshedModel(sm.from_cadquery(plate.add(cq.Workplane().sphere(0.6))), 0.4)


def test_their_nodes_are_known_before_they_are_made(unmeshed):
    there = unmeshed.jobs
    assert any(job.boundary.has_degenerate for job in there)
    numbers = list(range(len(there)))[::2][::-1]
    faces = [unmeshed.faces[k] for k in numbers]
    later = later_jobs(unmeshed.model, faces, unmeshed.nodes, {}, True)
    assert later.nodes == [there[k].nodes for k in numbers]
    later.make([1, 0])
    later.make(range(len(later)))
    for k, number in enumerate(numbers):
        assert later[k].surface is there[number].surface
        for name in ("uv", "points", "numbers", "sizes"):
            own, other = (getattr(job.boundary, name) for job in (later[k], there[number]))
            assert own.tobytes() == other.tobytes()


def test_each_is_made_once_and_some_together(unmeshed):
    asked = []

    def make(numbers):
        asked.append(numbers)
        return [unmeshed.jobs[k] for k in numbers]

    jobs = FaceJobs([4, 5, 6, 7], make)
    jobs.make([2])
    jobs.make([3, 2, 0])
    jobs.make([0, 2])
    assert asked == [[2], [3, 0]] and len(jobs) == 4
    assert jobs[3] is unmeshed.jobs[3]
    with pytest.raises(KeyError):
        jobs[1]


def test_those_that_are_there_have_their_own_nodes(unmeshed):
    jobs = FaceJobs.of(unmeshed.jobs)
    jobs.make(range(len(jobs)))
    assert [jobs[k].nodes for k in range(len(jobs))] == jobs.nodes
