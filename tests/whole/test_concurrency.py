"""No global state: threads and processes make the meshes that one thread makes."""

import multiprocessing
import threading
from concurrent.futures import ProcessPoolExecutor, ThreadPoolExecutor

import numpy as np
import pytest

import surfmesh as sm


def paraboloid(u, v):
    return u, v, 0.3 * (u * u + v * v)


def things():
    import cadquery as cq  # not in the processes of the pool

    return [
        sm.load("torus"),
        sm.ParametricSurface("u", "v", "sin(u)*cos(v)", u=(-2, 2), v=(-2, 2)),
        sm.NumericSurface(paraboloid, u=(-1, 1), v=(-1, 1)),
        sm.PlanarDomain([(0, 0), (4, 0), (4, 3), (0, 3)], constraints=[[(1, 1), (3, 2)]]),
        sm.from_cadquery(cq.Workplane().box(1, 2, 3).faces(">Z").workplane().hole(0.5)),
    ]


def meshed(thing):
    return sm.mesh(thing, sm.Sizing(angle=20, max_size=0.4, growth=1.4))


def same(a, b):
    return (
        np.array_equal(a.points, b.points)
        and np.array_equal(a.triangles, b.triangles)
        and np.array_equal(a.face_ids, b.face_ids)
    )


@pytest.fixture(scope="module")
def alone():
    return [meshed(thing) for thing in things()]


def test_threads_at_once(alone):
    start = threading.Barrier(4)

    def work(turn):
        start.wait()
        mine = things()
        order = np.roll(np.arange(len(mine)), turn)
        return {int(k): meshed(mine[k]) for k in order}

    with ThreadPoolExecutor(4) as pool:
        for found in pool.map(work, range(4)):
            assert all(same(found[k], mesh) for k, mesh in enumerate(alone))


def test_one_surface_in_several_threads():
    surface = sm.load("two_peaks")  # its derivatives are made when they are first needed
    with ThreadPoolExecutor(3) as pool:
        first, *others = pool.map(meshed, [surface] * 3)
    assert all(same(first, other) for other in others)


def test_a_pool_of_processes(alone):
    with ProcessPoolExecutor(2, mp_context=multiprocessing.get_context("spawn")) as pool:
        for found, mesh in zip(pool.map(meshed, things()), alone, strict=True):
            assert same(found, mesh)
            assert sm.check(found).clean == sm.check(mesh).clean


def test_stopping_one_thread_leaves_the_other_alone(alone):
    def stopped(_):
        with pytest.raises(sm.errors.Cancelled):
            sm.mesh(sm.load("torus"), 0.3, progress=lambda stage, fraction: fraction < 0.5)

    with ThreadPoolExecutor(2) as pool:
        gone = pool.submit(stopped, None)
        kept = pool.submit(meshed, things()[0])
        gone.result()
        assert same(kept.result(), alone[0])
