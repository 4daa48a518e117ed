"""What a finding is: its kind, its place and its numbers; the sentence is made when it is read."""

from abc import abstractmethod
from dataclasses import dataclass
from enum import Enum, auto

from surfmesh.quality.measures.places import Point


class Kind(Enum):
    """What a finding is about."""

    NO_TRIANGLES = auto()
    BROKEN_MESH = auto()  # an invariant of ``SurfaceMesh.broken_invariant``
    FACE_MISSING = auto()
    SOLID_OPEN = auto()
    EULER_NUMBER = auto()
    EDGES = auto()  # with other triangles than the model has faces there
    VERTICES = auto()  # with other fans of triangles
    ORIENTATION = auto()  # of neighbours, or of what is closed
    WITHOUT_AREA = auto()
    INVERTED = auto()
    FOLDED = auto()
    DEVIATION = auto()  # of the mesh from the surface
    SURFACE_DEVIATION = auto()  # of the surface from the mesh
    DIHEDRAL_ANGLE = auto()
    BETWEEN_SAMPLES = auto()  # features narrower than the triangles
    PROOF = auto()  # of the distance, where it was asked for
    SELF_INTERSECTION = auto()
    OVERLAP = auto()
    CONTACT = auto()  # bodies that touch or lie near, faces that were not sewn
    VOLUME = auto()
    AREA = auto()
    MIN_SIZE = auto()  # the user's, which forbids what was asked for
    SECOND_OPINION = auto()
    WARNING = auto()  # said when the mesh was made


@dataclass(frozen=True, kw_only=True)
class Finding:
    """One thing that is wrong with a mesh, or that should be known of it."""

    kind: Kind
    place: Point | None = None  # where in space, model units, if it is anywhere

    @property
    @abstractmethod
    def text(self) -> str:
        """The sentence."""

    def __str__(self) -> str:
        return self.text


@dataclass(frozen=True, kw_only=True)
class Problem(Finding):
    """The mesh is not clean."""


@dataclass(frozen=True, kw_only=True)
class Remark(Finding):
    """What is no fault of the mesh."""


@dataclass(frozen=True, kw_only=True)
class Fault(Problem):
    """A problem without numbers."""

    words: str

    @property
    def text(self) -> str:
        """As it is."""
        return self.words


@dataclass(frozen=True, kw_only=True)
class MissingFace(Problem):
    """A face of the model that could not be meshed."""

    kind: Kind = Kind.FACE_MISSING
    face: int | None  # None where it has no number: it was left out when the model was read
    words: str

    @property
    def text(self) -> str:
        """As the mesher said it."""
        return self.words


@dataclass(frozen=True, kw_only=True)
class Warned(Remark):
    """What was said when the mesh was made."""

    kind: Kind = Kind.WARNING
    words: str

    @property
    def text(self) -> str:
        """As the mesher said it."""
        return self.words
