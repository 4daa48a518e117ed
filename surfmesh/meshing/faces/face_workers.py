"""Who meshes the faces of a model: this thread, threads of this process, or any executor.

faces, most work first -> batches -> workers -> meshes, each with the number of its face
   |
   +-- one that would keep a thread busy after all others are done -> by itself, all threads

A face is meshed from plain arrays and knows nothing of the others, so that its mesh is the same
whoever makes it, and when.
"""

from collections.abc import Callable, Iterator, Sequence
from concurrent.futures import Executor, Future, ThreadPoolExecutor
from dataclasses import dataclass, replace
from heapq import heappop, heappush
from queue import SimpleQueue
from threading import Event

from surfmesh.meshing.executors import executor_faults
from surfmesh.meshing.faces.face_data import FaceJob, FaceMesh
from surfmesh.meshing.faces.face_jobs import FaceJobs
from surfmesh.meshing.faces.face_mesh import mesh_face
from surfmesh.meshing.faces.face_queue import CoreFaces, FaceQueue
from surfmesh.meshing.faces.partitions import FaceStore
from surfmesh.meshing.processors import allowed_threads

BATCHES = 64
"""Most batches that an executor is handed at a time: some for each of a dozen workers, so that
none waits long at the end, and not one for each of thousands of faces."""

FACE_WORK = 400
"""Work of a face besides its triangles, in triangles; from the seconds it takes."""


WITHIN_ONE = 0.7
"""What a thread does within a face that several mesh, of what it does on one of its own."""

AT_ONCE = 10_000
"""Triangles that a thread makes before it hands them over: some hundredths of a second."""

BEGUN = 64
"""Faces that threads begin with while the others are made ready."""

LITTLE = 20_000
"""Work in all, in triangles, that threads are not begun for: some hundredths of a second."""


@dataclass(frozen=True)
class FaceWorkers:
    """Meshes faces side by side."""

    threads: int = 1
    """How many of this process; 1: the caller's alone."""
    executor: Executor | None = None
    """Instead of threads: processes, or other machines. Jobs and meshes are pickled."""
    store: FaceStore | None = None
    """Where the meshes of faces stay; None: with the caller."""
    at_once: int = AT_ONCE
    """Triangles that a thread makes before the caller hears of them; at least a face."""

    def work(self, job: FaceJob) -> FaceMesh:
        """Mesh a face."""
        return self.kept(mesh_face(job))

    def kept(self, mesh: FaceMesh) -> FaceMesh:
        """A mesh that the caller has made of others, as ``meshed`` gives it."""
        return mesh if self.store is None else self.store.kept(mesh)

    def meshed(self, jobs: Sequence[FaceJob] | FaceJobs) -> Iterator[tuple[int, FaceMesh]]:
        """The number and the mesh of each job, in the order in which they are done.

        Those of ``FaceJobs`` are made when they are begun, most work first. Where the iterator is
        closed early, what has not begun is not done. Raises ``MeshingError`` when the executor has
        lost its workers, takes no work or cannot send it.
        """
        jobs = jobs if isinstance(jobs, FaceJobs) else FaceJobs.of(jobs)
        if self.executor is not None:
            yield from _by_executor(self.executor, jobs, BATCHES, replace(self, executor=None))
            return
        work = list(map(expected_work, jobs.nodes))
        waiting = sorted(range(len(work)), key=lambda k: (-work[k], k))
        threads = self.threads if sum(work) > LITTLE else 1
        if threads > 1 and self._is_to_be_shared(work[waiting[0]], sum(work)):
            largest = waiting.pop(0)
            jobs.make([largest])
            with allowed_threads(threads):
                mesh = self.work(jobs[largest])
            yield largest, mesh
        if threads > 1:
            yield from self._by_threads(jobs, waiting)
            return
        jobs.make(waiting)
        queue = FaceQueue(jobs, waiting)
        yield from ((k, self.work(jobs[k])) for k in queue.left)
        while made := queue.work(self.at_once):
            yield from ((k, self.kept(mesh)) for k, mesh in made)

    def _is_to_be_shared(self, largest: float, whole: float) -> bool:
        """Is all done sooner where threads work on the largest face together, then on the rest?"""
        shared = largest / (WITHIN_ONE * self.threads) + (whole - largest) / self.threads
        return largest > max(shared, whole / self.threads)

    def _by_threads(
        self, jobs: FaceJobs, waiting: list[int]
    ) -> Iterator[tuple[int, FaceMesh]]:  # fmt: skip
        """waiting: jobs in their order. The first are begun before the others are made ready."""
        makes = CoreFaces()
        jobs.make(waiting[:BEGUN])
        queues = [FaceQueue(jobs, waiting[:BEGUN], makes)]
        single = queues[0].left[::-1]  # what the core does not mesh by itself; the last is next
        is_ready = Event()
        done: SimpleQueue[list[tuple[int, FaceMesh]] | BaseException] = SimpleQueue()

        def next_ones() -> list[tuple[int, FaceMesh]]:
            while True:
                all_known = is_ready.is_set()
                try:
                    k = single.pop()
                    return [(k, self.work(jobs[k]))]
                except IndexError:  # none is left
                    pass
                for queue in queues:
                    if made := queue.work(self.at_once):
                        return [(k, self.kept(mesh)) for k, mesh in made]
                if all_known:
                    return []
                is_ready.wait()

        def take_all() -> None:
            try:
                while made := next_ones():
                    done.put(made)
            except BaseException as error:
                done.put(error)

        with ThreadPoolExecutor(self.threads) as pool:
            try:
                begun = _begun(pool, self.threads, take_all)
                jobs.make(waiting[BEGUN:])
                queues.append(FaceQueue(jobs, waiting[BEGUN:], makes))
                single[:0] = queues[1].left[::-1]
                is_ready.set()
                if not begun:
                    take_all()
                left = len(waiting)
                while left:
                    found = done.get()
                    if isinstance(found, BaseException):
                        raise found
                    left -= len(found)
                    yield from found
            finally:
                single.clear()
                for queue in queues:
                    queue.stop()
                is_ready.set()


def _begun(pool: ThreadPoolExecutor, threads: int, work: Callable[[], None]) -> int:
    """How many threads have begun with ``work``: fewer where the system gives no more."""
    for count in range(threads):
        try:
            pool.submit(work)
        except RuntimeError:
            return count
    return threads


def _by_executor(
    executor: Executor, jobs: FaceJobs, batches: int, workers: FaceWorkers
) -> Iterator[tuple[int, FaceMesh]]:
    futures: dict[int, tuple[Future[list[FaceMesh]], int]] = {}
    try:
        jobs.make(range(len(jobs)))
        with executor_faults("mesh the faces"):
            for batch in batches_of(list(map(expected_work, jobs.nodes)), batches):
                future = executor.submit(_mesh_batch, workers, [jobs[k] for k in batch])
                futures.update({k: (future, place) for place, k in enumerate(batch)})
            for k in range(len(jobs)):
                future, place = futures[k]
                yield k, future.result()[place]
    finally:
        for future, _ in futures.values():
            future.cancel()


def _mesh_batch(workers: FaceWorkers, jobs: list[FaceJob]) -> list[FaceMesh]:
    """By another process, with one thread."""
    made = dict(replace(workers, threads=1).meshed(jobs))
    return [made[k] for k in range(len(jobs))]


def expected_work(nodes: int) -> float:
    """About how much there is to do, in triangles: as of a square with so many nodes around."""
    return FACE_WORK + nodes**2 / 8.0


def batches_of(work: list[float], count: int) -> list[list[int]]:
    """Numbers 0, 1, ... in at most ``count`` batches of about the same work, most work first.

    Each number goes, most work first, to the batch with the least (Graham's rule).
    """
    order = sorted(range(len(work)), key=lambda k: -work[k])
    if len(order) <= count:
        return [[k] for k in order]
    batches: list[list[int]] = [[] for _ in range(count)]
    heap = [(0.0, n) for n in range(count)]
    for k in order:
        load, n = heappop(heap)
        batches[n].append(k)
        heappush(heap, (load + work[k], n))
    return batches
