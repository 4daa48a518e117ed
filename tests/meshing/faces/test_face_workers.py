"""Faces are meshed side by side, by threads, processes and machines: the same mesh, bit for bit."""

import os
import pickle
import signal
import subprocess
import sys
from concurrent.futures import Future, ProcessPoolExecutor, ThreadPoolExecutor
from multiprocessing import get_context
from threading import Thread, active_count
from time import sleep
from types import SimpleNamespace

import cadquery as cq
import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

import surfmesh as sm
from surfmesh._core import allow_threads
from surfmesh.errors import Cancelled, MeshingError
from surfmesh.meshing.estimate.unmeshed_model import UnmeshedModel
from surfmesh.meshing.executors import executor_faults
from surfmesh.meshing.faces import face_queue, face_workers
from surfmesh.meshing.faces.face_workers import FaceWorkers, batches_of

SIZE = 0.7


def part():
    return cq.Workplane().box(4, 3, 1).faces(">Z").workplane().hole(1).edges("|Z").fillet(0.3)


def same(one, other) -> bool:
    return np.array_equal(one.points, other.points) and np.array_equal(
        one.triangles, other.triangles
    )


@pytest.fixture(scope="module")
def by_one():
    return sm.mesh(part(), SIZE)


@given(st.lists(st.floats(0.0, 1e9), max_size=40), st.integers(1, 9))
def test_batches_hold_each_number_once_and_share_the_work(work, count):
    batches = batches_of(work, count)
    assert len(batches) <= max(count, len(work)) and len(batches) <= max(count, 1)
    assert sorted(k for batch in batches for k in batch) == list(range(len(work)))
    loads = [sum(work[k] for k in batch) for batch in batches]
    if work:
        assert max(loads) <= sum(work) / count + max(work) * (1 + 1e-9) + 1e-6


@pytest.fixture
def threads_for_all(monkeypatch):
    monkeypatch.setattr(face_workers, "LITTLE", 0)


@pytest.fixture
def none_by_the_core(monkeypatch):
    monkeypatch.setattr(face_queue.CoreFaces, "face", lambda *_: None)


ARRAYS = "points triangles uv_points uv_triangles face_ids sizes edge_segments vertex_ids".split()


@pytest.mark.parametrize("begun", [2, face_workers.BEGUN])
@pytest.mark.parametrize("sizing", [sm.Sizing(size=SIZE), sm.Sizing(chord=0.01, anisotropy=4)])
def test_threads_change_no_byte(sizing, begun, threads_for_all, monkeypatch):
    monkeypatch.setattr(face_workers, "BEGUN", begun)
    model = sm.from_cadquery(part())
    first, *others = [sm.mesh(model, sizing, jobs=jobs) for jobs in (1, 2, 3, 7)]
    for mesh in others:
        for name in ARRAYS:
            assert getattr(first, name).tobytes() == getattr(mesh, name).tobytes(), name


def test_one_large_face_has_all_threads_and_others_one_each(
    threads_for_all, none_by_the_core, monkeypatch
):
    def mesh_face(job):
        allowed = allow_threads(1)
        allow_threads(allowed)
        return job.nodes, allowed

    monkeypatch.setattr(face_workers, "mesh_face", mesh_face)
    jobs = [SimpleNamespace(nodes=nodes) for nodes in (8, 900, 40, 12)]
    asked = dict(FaceWorkers(2).meshed(jobs))
    assert asked == {0: (8, 1), 1: (900, 2), 2: (40, 1), 3: (12, 1)} and next(iter(asked)) == 1
    assert dict(FaceWorkers(2).meshed(jobs[2:])) == {0: (40, 1), 1: (12, 1)}
    even = [SimpleNamespace(nodes=40)] * 5
    assert dict(FaceWorkers(2).meshed(even)) == dict.fromkeys(range(5), (40, 1))


def test_what_goes_wrong_in_a_thread_comes_out(threads_for_all, none_by_the_core, monkeypatch):
    def broken(job):
        raise MemoryError("no room")

    monkeypatch.setattr(face_workers, "mesh_face", broken)
    with pytest.raises(MemoryError, match="no room"):
        sm.mesh(part(), SIZE, jobs=2)


def test_threads_end_where_the_other_faces_cannot_be_made_ready(threads_for_all, monkeypatch):
    class SecondFails(face_queue.FaceQueue):
        def __init__(self, jobs, order, inward):
            if len(order) != 2:
                raise MemoryError("no room")
            super().__init__(jobs, order, inward)

    monkeypatch.setattr(face_workers, "BEGUN", 2)
    monkeypatch.setattr(face_workers, "FaceQueue", SecondFails)
    before = active_count()
    with pytest.raises(MemoryError, match="no room"):
        sm.mesh(part(), SIZE, jobs=2)
    assert active_count() == before


def test_threads_end_when_the_caller_stops(threads_for_all, none_by_the_core, monkeypatch):
    made = []

    def mesh_face(job):
        sleep(0.01)
        made.append(job)
        return job

    monkeypatch.setattr(face_workers, "mesh_face", mesh_face)
    before = active_count()
    meshes = FaceWorkers(2).meshed([SimpleNamespace(nodes=4)] * 500)
    next(meshes)
    meshes.close()
    assert len(made) < 250 and active_count() == before


def test_the_callers_no_is_heard_between_faces(threads_for_all):
    with pytest.raises(Cancelled):
        sm.mesh(part(), SIZE, jobs=2, progress=lambda stage, done: done < 0.21)


def test_processes_change_nothing(by_one):
    model = sm.from_cadquery(part())
    with ProcessPoolExecutor(2, mp_context=get_context("spawn")) as executor:
        assert same(by_one, sm.mesh(model, SIZE, executor=executor))


def test_a_job_is_done_without_the_cad_kernel():
    jobs = pickle.dumps(UnmeshedModel(sm.from_cadquery(part()), SIZE).jobs)
    code = """if True:
        import pickle, sys
        from surfmesh.meshing.faces.face_mesh import mesh_face
        meshes = [mesh_face(job) for job in pickle.load(sys.stdin.buffer)]
        assert all(len(mesh.triangles) for mesh in meshes)
        sys.exit("OCP" in sys.modules)
    """
    subprocess.run([sys.executable, "-c", code], input=jobs, check=True)


class OneIsLost(ProcessPoolExecutor):
    """Kills its workers when the first batch is handed over."""

    def submit(self, *what, **more) -> Future:
        future = super().submit(*what, **more)
        for process in list(self._processes.values()):
            process.kill()  # not by its number, which another may have by now
        return future


def test_lost_processes_are_named():
    with OneIsLost(1, mp_context=get_context("spawn")) as executor:
        with pytest.raises(MeshingError, match="workers that mesh the faces are lost"):
            sm.mesh(part(), SIZE, executor=executor)


def test_processes_that_are_shut_down_take_no_work():
    with ProcessPoolExecutor(1, mp_context=get_context("spawn")) as executor:
        pass
    with pytest.raises(MeshingError, match="executor that is to mesh the faces is shut down: call"):
        sm.mesh(part(), SIZE, executor=executor)


def test_laws_that_cannot_be_sent_are_said_to_be_so():
    with ProcessPoolExecutor(1, mp_context=get_context("spawn")) as executor:
        with pytest.raises(MeshingError, match=r"cannot be sent to them .*: laws .* no lambdas"):
            sm.mesh(part(), lambda points: np.full(len(points), 2.0), executor=executor)


def test_faults_of_the_work_itself_are_left_as_they_are():
    def law(points):
        raise AttributeError("no such thing")

    with ThreadPoolExecutor(1) as executor, executor_faults("mesh"):
        with pytest.raises(AttributeError, match="no such thing"):
            executor.submit(law, None).result()


@pytest.mark.skipif(os.name == "nt", reason="a worker is killed by a signal")
def test_two_machines_one_of_them_killed_half_way(by_one):
    distributed = pytest.importorskip("distributed", reason="Dask is not installed")
    with distributed.LocalCluster(
        n_workers=2, threads_per_worker=1, processes=True, dashboard_address=None
    ) as cluster, distributed.Client(cluster) as client:  # fmt: skip
        model = sm.from_cadquery(part())
        victim = next(iter(client.run(os.getpid).values()))

        def kill() -> None:
            sleep(0.3)
            os.kill(victim, signal.SIGKILL)

        killer = Thread(target=kill)
        killer.start()
        mesh = sm.mesh(model, SIZE, executor=client.get_executor())
        killer.join()
    assert same(by_one, mesh)
