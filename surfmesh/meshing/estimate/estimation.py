"""How many triangles there will be, and how much memory they need, before all are packed.

    size field -> metric area inside the loops -> unit triangles -> bytes
    or boundary nodes, where a face has little more than them

Small meshes are made where the first round does not tell the last (``trial_mesh``). Of large ones a
few patches or faces are, and what the optimiser makes of them is taken for the rest
(``trial_patches``, ``trial_faces``). Not seen, in a mesh too large to be made, are edges that faces
away from the patches ask to be finer, and faces with folds of their own.
"""

from __future__ import annotations

import mmap
import os
import sys
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from surfmesh.errors import SizingError
from surfmesh.sizing.field.metric_area import TRIANGLES, metric_area
from surfmesh.sizing.field.size_field import COUNTABLE, SizeField

RESULT, MODEL_RESULT, WORK, STRETCHED_WORK = 150, 450, 80, 530
"""Bytes a triangle of the whole mesh, of one joined from the faces of a model, and of the face
being worked on; measured, peak of the process for meshes of 0.2 to 1.9 million triangles."""

MANY = 10**15
"""Triangles: more are told in powers of ten."""

COARSENESS, COARSENESS_STRETCHED = 3.0, 1.5
"""Of the size field of a surface of formulas: fewer cells where it bends much, and less so where
sizes depend on the direction. The count changes by .2 % on two_peaks, .8 on wavy."""

SHARP = 6.0
"""How sharply the count of a face changes from that of its boundary to that of its area."""

LOADED, CAD_LOADED = 250_000_000, 550_000_000
"""Bytes of the program itself, and of the CAD kernel where it lives in this process."""


@dataclass(frozen=True)
class Estimate:
    """What a mesh will be like."""

    triangles: int
    by_face: tuple[int, ...]
    """Triangles on each face; one entry for a single surface."""
    memory: int
    """Bytes at the peak of meshing, the program included."""
    mesh_memory: int = 0
    """Bytes of that which the mesh takes, and the work on it: what the program has anyway is not
    among them."""
    least_triangles: float | None = None
    """Those of any shape that ``chord`` needs at least, as the report has it; None without a chord,
    in planar domains, and where triangles are quadratic."""

    @property
    def efficiency(self) -> float | None:
        """``least_triangles / triangles``."""
        return None if self.least_triangles is None else self.least_triangles / self.triangles

    def __str__(self) -> str:
        own, whole = size_in_words(self.mesh_memory), size_in_words(self.memory)
        times = ""
        if self.least_triangles:
            times = (
                f"; {self.triangles / self.least_triangles:.3g} times the least that triangles of "
                "any shape need for chord"
            )
        return (
            f"about {self.triangles:,} triangles, {own} of memory at the peak, {whole} with the "
            f"program{times}"
        )

    def to_dict(self) -> dict:
        """Plain data for JSON."""
        return {
            "triangles": self.triangles, "memory_bytes": self.memory,
            "mesh_memory_bytes": self.mesh_memory, "by_face": list(self.by_face),
            "least_triangles": self.least_triangles, "efficiency": self.efficiency,
        }  # fmt: skip

    @classmethod
    def of(
        cls, by_face: Sequence[float] | np.ndarray, stretched: bool = False, model: bool = False,
        least: float | None = None,
    ) -> Estimate:  # fmt: skip
        """stretched: sizes depend on the direction. least: ``least_triangles``."""
        counts = tuple(np.rint(np.fmin(by_face, COUNTABLE)).astype(np.int64).tolist())
        total, most = sum(counts), max(counts, default=0)
        loaded = max(LOADED + (CAD_LOADED if "OCP" in sys.modules else 0), _resident())
        bytes_each = MODEL_RESULT if model else RESULT
        work = STRETCHED_WORK if stretched else WORK
        own = bytes_each * total + work * most
        return cls(total, counts, loaded + own, own, least)


def _resident() -> int:
    """Bytes that this process has now, its models among them; 0 where the system does not say."""
    try:
        figures = os.open("/proc/self/statm", os.O_RDONLY)  # open() would take twice as long
        try:
            return int(os.read(figures, 256).split()[1]) * mmap.PAGESIZE
        finally:
            os.close(figures)
    except (OSError, ValueError, IndexError):
        return 0


def size_in_words(count: float) -> str:
    """Bytes as "1.2 GB"."""
    for unit in ("bytes", "kB", "MB", "GB", "TB"):
        if count < 1000.0 or unit == "TB":
            return f"{count:.3g} {unit}"
        count /= 1000.0
    return ""


def field_triangles(field: SizeField, loops: Sequence[np.ndarray] | None = None) -> float:
    """Triangles over the field's rectangle, or inside ``loops`` (k, 2) in (u, v)."""
    return TRIANGLES * metric_area(field, loops)


def fewest_triangles(nodes: int, loops: int) -> int:
    """Within loops of so many nodes when none lies inside, by Euler's formula."""
    return nodes + 2 * loops - 4


def combined(inside: np.ndarray, fewest: np.ndarray) -> np.ndarray:
    """Triangles (f,) of faces: of those (f,) that the area asks for, and of the fewest (f,) that
    the loops allow."""
    least = np.maximum(fewest, 1.0)
    larger = np.minimum(np.maximum(inside, least), COUNTABLE)
    ratio = np.minimum(inside, least) / larger
    found = larger * (1.0 + ratio**SHARP) ** (1.0 / SHARP)
    return np.where(larger < COUNTABLE, found, COUNTABLE)


def _counted(triangles: int) -> str:
    return f"{triangles:,}" if triangles < MANY else f"{triangles:.2g}"


def require_within(limit: int, found: Estimate, names: Sequence[str]) -> None:
    """Raise ``SizingError`` with advice when there would be more triangles than ``limit``."""
    if found.triangles <= limit:
        return
    most = int(np.argmax(found.by_face))
    on = f", {found.by_face[most]:,} of them on {names[most]}" if len(names) > 1 else ""
    raise SizingError(
        f"about {_counted(found.triangles)} triangles are asked for{on}, more than the limit of "
        f"{limit:,}; they need {size_in_words(found.memory)} of memory. Ask for a larger chord, "
        "size or min_size there, or raise limit"
    )


def require_field_within(
    limit: int, field: SizeField, loops: Sequence[np.ndarray] | None, name: str
) -> None:
    """The same for a single surface, before it is packed."""
    if 2 * field.expected_vertices() > limit:
        require_within(limit, Estimate.of([field_triangles(field, loops)]), [name])
