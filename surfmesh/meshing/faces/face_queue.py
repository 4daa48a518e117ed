"""Ordinary faces, which the core meshes one after the other without the interpreter.

jobs -> faces of the core, most work first -> FaceQueue of the core -> rows of arrays -> face meshes
                                                  |
                what is out of the ordinary <-----+  goes on in face_mesh.py
"""

from collections.abc import Iterable, Sequence
from itertools import pairwise

from surfmesh._core import faces as core
from surfmesh.meshing.faces.face_data import FaceJob, FaceMesh
from surfmesh.meshing.faces.face_in_rows import FaceInRows
from surfmesh.meshing.faces.face_jobs import FaceJobs
from surfmesh.meshing.faces.face_mesh import continued
from surfmesh.meshing.faces.graded_faces import GradedFaces
from surfmesh.meshing.faces.inward_faces import InwardFaces


class CoreFaces:
    """Makes of jobs what the core meshes by itself."""

    def __init__(self) -> None:
        self._inward, self._graded = InwardFaces(), GradedFaces()

    def face(self, job: FaceJob) -> core.InwardFace | core.GradedFace | None:
        """None where a job needs another way from the start."""
        exact = job.exact
        if job.narrow is not None or (exact is not None and exact.may_be_wrong and exact.at_once):
            return None
        try:
            return self._inward.face(job, look_for_tubes=True) or self._graded.face(job)
        except Exception:  # face_mesh.py comes upon it again, and puts it into words
            return None


class FaceQueue:
    """Faces that the core meshes, whoever calls for the next ones."""

    def __init__(
        self, jobs: Sequence[FaceJob] | FaceJobs, order: Iterable[int],
        makes: CoreFaces | None = None,
    ) -> None:  # fmt: skip
        """order: numbers of the jobs, as they are to be begun; what the core cannot mesh is left.
        makes: what makes faces of them, where several queues do."""
        self._jobs = jobs
        self._numbers: list[int] = []
        """Of the jobs that it takes."""
        self.left: list[int] = []
        """Of the jobs that it does not take, in their order."""
        faces, makes = [], makes or CoreFaces()
        for number in order:
            face = makes.face(jobs[number])
            if face is None:
                self.left.append(number)
            else:
                self._numbers.append(number)
                faces.append(face)
        self._core = core.FaceQueue(faces)

    def work(self, triangles: int) -> list[tuple[int, FaceMesh]]:
        """The numbers and meshes of the next jobs, until so many triangles are made; none when
        nothing is left."""
        finished = self._core.work(triangles)
        made = _in_rows(finished.rows)
        made += [(face, continued(self._jobs[self._numbers[face]], begun))
                 for face, begun in finished.others]  # fmt: skip
        return [(self._numbers[face], mesh) for face, mesh in made]

    def stop(self) -> None:
        """Nothing is begun any more, and what is under way is given up."""
        self._core.stop()


def _in_rows(rows: core.FaceRows) -> list[tuple[int, FaceMesh]]:
    """Numbers in the queue and meshes of the faces that ask for nothing."""
    ends = pairwise([0, *rows.triangle_end.tolist()])
    return [
        (face, FaceInRows(rows, place, last - first))
        for place, (face, (first, last)) in enumerate(zip(rows.face.tolist(), ends))
    ]
