"""What holds where nothing is asked for, in one place: lengths are relative to the diagonal of the
bounding box, model units."""

from surfmesh._core import patch
from surfmesh._core import sizing as core_sizing
from surfmesh.errors import SizingError
from surfmesh.sizing.options.sizing import Sizing

DEFAULT_CHORD = 1e-3
"""``chord`` where neither a chord nor an angle nor a size is asked for."""

DEFAULT_MAX_SIZE = core_sizing.DEFAULT_MAX_SIZE  # 0.1
"""``max_size``."""

LONGEST = core_sizing.LONGEST_SIZE  # 1
"""Likewise for the longer of two sizes of an anisotropic metric."""

FINEST_SIZE = core_sizing.FINEST_SIZE  # 1e-5
"""No size is smaller, unless ``min_size`` says so: at an apex the curvature is infinite."""

FINEST_BY_ANGLE = core_sizing.FINEST_BY_ANGLE  # 2e-4
"""``angle`` asks for no smaller size: triangles about an apex are bent by as much at any size."""

DEFAULT_ANGLE = 45.0
"""Degrees; kept wherever sizes follow the curvature by ``chord`` alone."""

LEAST_OF_CHORD = patch.LEAST_OF_CHORD  # 0.5
"""The default angle asks for nothing smaller than this fraction of ``chord``: an apex is no
fold."""


def with_default_chord(sizing: Sizing, diagonal: float) -> Sizing:
    """Sizes that follow from something: ``DEFAULT_CHORD`` where nothing is asked for.

    Raises ``SizingError`` for a number of triangles, which only a whole mesh has.
    """
    if sizing.triangles is not None:
        raise SizingError(
            f"triangles={sizing.triangles:,} is met by mesh, estimate and explain, for everything "
            "together; here give a chord or a size"
        )
    if sizing.chord is None and sizing.angle is None and sizing.size is None:
        return sizing.replaced(chord=DEFAULT_CHORD * diagonal)
    return sizing


def with_defaults(sizing: Sizing, diagonal: float) -> Sizing:
    """The same with the default of ``max_size`` filled in too."""
    sizing = with_default_chord(sizing, diagonal)
    if sizing.max_size is None and sizing.size is None:
        sizing = sizing.replaced(max_size=default_max_size(sizing, diagonal))
    return sizing


def default_max_size(sizing: Sizing, diagonal: float, times: float = 1.0) -> float:
    """The default of ``max_size``, so many times, where ``min_size`` leaves room for it."""
    fraction = LONGEST if sizing.is_anisotropic else DEFAULT_MAX_SIZE
    return max(fraction * diagonal * times, sizing.min_size or 0.0)
