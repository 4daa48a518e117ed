"""Who meshes the faces of a model: this thread, threads of this process, or any executor.

faces, most work first -> batches -> workers -> meshes in the order of the faces

A face is meshed from plain arrays and knows nothing of the others, so that its mesh is the same
whoever makes it, and when.
"""

from collections.abc import Callable, Iterator
from concurrent.futures import BrokenExecutor, Executor, Future, ThreadPoolExecutor
from dataclasses import dataclass
from heapq import heappop, heappush

from surfmesh.errors import MeshingError
from surfmesh.meshing.faces.face_data import FaceJob, FaceMesh
from surfmesh.meshing.faces.face_mesh import mesh_face
from surfmesh.meshing.faces.partitions import FaceStore

BATCHES = 64
"""Most batches that an executor is handed at a time: some for each of a dozen workers, so that
none waits long at the end, and not one for each of thousands of faces."""

FACE_WORK = 400
"""Work of a face besides its triangles, in triangles; from the seconds it takes."""


@dataclass(frozen=True)
class FaceWorkers:
    """Meshes faces side by side."""

    threads: int = 1
    """How many of this process; 1: the caller's alone."""
    executor: Executor | None = None
    """Instead of threads: processes, or other machines. Jobs and meshes are pickled."""
    store: FaceStore | None = None
    """Where the meshes of faces stay; None: with the caller."""

    @property
    def work(self) -> Callable[[FaceJob], FaceMesh]:
        """What is done for each face."""
        return mesh_face if self.store is None else self.store.meshed

    def kept(self, mesh: FaceMesh) -> FaceMesh:
        """A mesh that the caller has made of others, as ``meshed`` gives it."""
        return mesh if self.store is None else self.store.kept(mesh)

    def meshed(self, jobs: list[FaceJob]) -> Iterator[FaceMesh]:
        """The meshes of all jobs, in their order.

        Where the iterator is closed early, what has not begun is not done. Raises
        ``MeshingError`` when the executor has lost its workers.
        """
        if self.executor is not None:
            yield from _by_executor(self.executor, jobs, BATCHES, self.work)
        elif self.threads > 1 and len(jobs) > 1:
            with ThreadPoolExecutor(min(self.threads, len(jobs))) as threads:
                yield from _by_executor(threads, jobs, len(jobs), self.work)
        else:
            yield from map(self.work, jobs)


def _by_executor(
    executor: Executor, jobs: list[FaceJob], batches: int, work: Callable[[FaceJob], FaceMesh]
) -> Iterator[FaceMesh]:
    futures: dict[int, tuple[Future[list[FaceMesh]], int]] = {}
    try:
        for batch in batches_of(list(map(expected_work, jobs)), batches):
            future = executor.submit(_mesh_batch, work, [jobs[k] for k in batch])
            futures.update({k: (future, place) for place, k in enumerate(batch)})
        for k in range(len(jobs)):
            future, place = futures[k]
            yield future.result()[place]
    except BrokenExecutor as error:
        raise MeshingError(f"the workers that mesh the faces are lost: {error}") from error
    finally:
        for future, _ in futures.values():
            future.cancel()


def _mesh_batch(work: Callable[[FaceJob], FaceMesh], jobs: list[FaceJob]) -> list[FaceMesh]:
    return list(map(work, jobs))


def expected_work(job: FaceJob) -> float:
    """About how much there is to do, in triangles: as of a square with so many nodes around."""
    return FACE_WORK + job.nodes**2 / 8.0


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
