"""What went wrong, as records: kind, face, place and reason; the sentence is made at the end."""

from __future__ import annotations

from dataclasses import dataclass
from enum import Enum


class FindingKind(Enum):
    """What a finding is about; the value starts its sentence, or is empty."""

    NOT_MESHED = "not meshed: "  # a face of the model is missing: such a mesh is not clean
    OFF_SURFACE = ""  # a face was closed between its edges, or left out between its neighbours


@dataclass(frozen=True, slots=True)
class Finding:
    """One thing that the user should know of a mesh."""

    kind: FindingKind
    reason: str
    face: int | None = None
    """Number of the face; None where it has none, as it was left out when the model was read."""
    label: str = ""
    """What the face is called: ``face 3 (lid)``."""
    place: tuple[float, float, float] | None = None
    """Where in space, model units, if that is known."""

    @property
    def text(self) -> str:
        """The sentence."""
        return f"{self.kind.value}{self.label}{': ' if self.label else ''}{self.reason}"
