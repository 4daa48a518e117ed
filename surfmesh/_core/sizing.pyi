"""
What sizes are asked for on one surface: rules, limits, and the law of a size field.
"""

from collections.abc import Sequence
from typing import Annotated

import numpy
from numpy.typing import NDArray

import surfmesh._core.fields
import surfmesh._core.surfaces


DEVIATION_RESERVE: float = 0.74

ALIKE_RESERVE: float = 0.78

ROUND_RESERVE: float = 0.78

BENT_RESERVE: float = 0.94

STRETCHED_RESERVE: float = 0.7

STRAIGHT_RESERVE: float = 0.75

def deviation_factor(k1: Annotated[NDArray[numpy.float64], dict(shape=(None,), order='C', device='cpu', writable=False)], k2: Annotated[NDArray[numpy.float64], dict(shape=(None,), order='C', device='cpu', writable=False)]) -> Annotated[NDArray[numpy.float64], dict(shape=(None,))]:
    """c (n,) with deviation = c h^2."""

def chord_size(k1: Annotated[NDArray[numpy.float64], dict(shape=(None,), order='C', device='cpu', writable=False)], k2: Annotated[NDArray[numpy.float64], dict(shape=(None,), order='C', device='cpu', writable=False)], chord: float) -> Annotated[NDArray[numpy.float64], dict(shape=(None,))]:
    """Edge length (n,) at which triangles stay within chord."""

def lattice_chord_size(k1: Annotated[NDArray[numpy.float64], dict(shape=(None,), order='C', device='cpu', writable=False)], k2: Annotated[NDArray[numpy.float64], dict(shape=(None,), order='C', device='cpu', writable=False)], chord: float) -> Annotated[NDArray[numpy.float64], dict(shape=(None,))]:
    """The same of a lattice laid where it deviates least."""

def quadratic_chord_size(k1: Annotated[NDArray[numpy.float64], dict(shape=(None,), order='C', device='cpu', writable=False)], k2: Annotated[NDArray[numpy.float64], dict(shape=(None,), order='C', device='cpu', writable=False)], chord: float) -> Annotated[NDArray[numpy.float64], dict(shape=(None,))]:
    """Edge length (n,) at which quadratic triangles stay within chord."""

def share_of_width(k1: Annotated[NDArray[numpy.float64], dict(shape=(None,), order='C', device='cpu', writable=False)], k2: Annotated[NDArray[numpy.float64], dict(shape=(None,), order='C', device='cpu', writable=False)], ratio: Annotated[NDArray[numpy.float64], dict(shape=(None,), order='C', device='cpu', writable=False)]) -> Annotated[NDArray[numpy.float64], dict(shape=(None,))]:
    """
    Fraction (n,) of a chord that may be used where it is the width of the band that a triangle needs.
    """

def angle_size(k1: Annotated[NDArray[numpy.float64], dict(shape=(None,), order='C', device='cpu', writable=False)], k2: Annotated[NDArray[numpy.float64], dict(shape=(None,), order='C', device='cpu', writable=False)], angle: float) -> Annotated[NDArray[numpy.float64], dict(shape=(None,))]:
    """Edge length (n,) at which dihedral angles are at most angle (degrees)."""

def normal_deviation_size(k1: Annotated[NDArray[numpy.float64], dict(shape=(None,), order='C', device='cpu', writable=False)], k2: Annotated[NDArray[numpy.float64], dict(shape=(None,), order='C', device='cpu', writable=False)], angle: float) -> Annotated[NDArray[numpy.float64], dict(shape=(None,))]:
    """
    Edge length (n,) at which the normals of neighbours differ by at most angle (degrees).
    """

def principal_chord_sizes(k1: Annotated[NDArray[numpy.float64], dict(shape=(None,), order='C', device='cpu', writable=False)], k2: Annotated[NDArray[numpy.float64], dict(shape=(None,), order='C', device='cpu', writable=False)], chord: float, ratio: Annotated[NDArray[numpy.float64], dict(shape=(None,), order='C', device='cpu', writable=False)]) -> tuple[Annotated[NDArray[numpy.float64], dict(shape=(None,))], Annotated[NDArray[numpy.float64], dict(shape=(None,))]]:
    """Edge lengths (n,), (n,) along the directions of k1 and k2, likewise."""

def evened_chord_sizes(k1: Annotated[NDArray[numpy.float64], dict(shape=(None,), order='C', device='cpu', writable=False)], k2: Annotated[NDArray[numpy.float64], dict(shape=(None,), order='C', device='cpu', writable=False)], chord: float, ratio: Annotated[NDArray[numpy.float64], dict(shape=(None,), order='C', device='cpu', writable=False)]) -> tuple[Annotated[NDArray[numpy.float64], dict(shape=(None,))], Annotated[NDArray[numpy.float64], dict(shape=(None,))]]:
    """The same of triangles whose corners move until they lie nearer."""

def saddle_lattice_sizes(k1: Annotated[NDArray[numpy.float64], dict(shape=(None,), order='C', device='cpu', writable=False)], k2: Annotated[NDArray[numpy.float64], dict(shape=(None,), order='C', device='cpu', writable=False)], chord: float, ratio: Annotated[NDArray[numpy.float64], dict(shape=(None,), order='C', device='cpu', writable=False)]) -> tuple[Annotated[NDArray[numpy.float64], dict(shape=(None,))], Annotated[NDArray[numpy.float64], dict(shape=(None,))]]:
    """The same of a lattice laid on a saddle where it deviates least."""

def principal_angle_sizes(k1: Annotated[NDArray[numpy.float64], dict(shape=(None,), order='C', device='cpu', writable=False)], k2: Annotated[NDArray[numpy.float64], dict(shape=(None,), order='C', device='cpu', writable=False)], angle: float, ratio: Annotated[NDArray[numpy.float64], dict(shape=(None,), order='C', device='cpu', writable=False)]) -> tuple[Annotated[NDArray[numpy.float64], dict(shape=(None,))], Annotated[NDArray[numpy.float64], dict(shape=(None,))]]:
    """Edge lengths (n,), (n,) along the directions of k1 and k2, likewise."""

RIM_RESERVE: float = 0.95

def rim_sizes(surface: surfmesh._core.surfaces.Surface, uv: Annotated[NDArray[numpy.float64], dict(shape=(None, 2), order='C', device='cpu', writable=False)], step: Annotated[NDArray[numpy.float64], dict(shape=(None, 2), order='C', device='cpu', writable=False)], chord: float) -> tuple[Annotated[NDArray[numpy.float64], dict(shape=(None,))], Annotated[NDArray[numpy.float64], dict(shape=(None, 3))]]:
    """
    Sizes (n,) that the curvature of lines of (u, v) allows along them, at uv (n, 2) in the directions step (n, 2), and unit tangents (n, 3); infinite and zero where a line has no speed.
    """

def least_densities(k1: Annotated[NDArray[numpy.float64], dict(shape=(None,), order='C', device='cpu', writable=False)], k2: Annotated[NDArray[numpy.float64], dict(shape=(None,), order='C', device='cpu', writable=False)], chord: float, balanced: bool) -> tuple[Annotated[NDArray[numpy.float64], dict(shape=(None,))], Annotated[NDArray[numpy.float64], dict(shape=(None,))]]:
    """
    The fewest triangles on a unit of area (n,) that chord allows, whatever their shape, and the fewest equilateral ones (n,). balanced: vertices may lie off the surface.
    """

def least_segments(line: Annotated[NDArray[numpy.float64], dict(shape=(None, 3), order='C', device='cpu', writable=False)], closed: bool, chord: float, balanced: bool) -> float:
    """
    The fewest segments that chord allows along a line with nodes (n, 3). closed: the first node, which is not repeated, follows the last.
    """

class CurvatureRule:
    """Sizes that follow from the curvature."""

class PlaceRule:
    """Sizes that depend on the place alone."""

class ChordRule(CurvatureRule):
    def __init__(self, chord: float, is_width: bool = False, on_lattice: bool = False, evened: bool = False) -> None:
        """
        is_width: chord is that of the whole band that a triangle needs. on_lattice: edges lie where they deviate least. evened: of stretched triangles whose corners move until they lie nearer.
        """

class QuadraticChordRule(CurvatureRule):
    def __init__(self, chord: float) -> None: ...

class AngleRule(CurvatureRule):
    def __init__(self, angle: float, finest: float) -> None:
        """angle: degrees. finest: nothing smaller is asked for, model units."""

class NormalDeviationRule(CurvatureRule):
    def __init__(self, angle: float, finest: float) -> None:
        """Likewise."""

class ConstantSize(PlaceRule):
    def __init__(self, size: float) -> None: ...

class CallbackCurvatureRule(CurvatureRule):
    def __init__(self, rule: object) -> None:
        """rule: a CurvatureRule of surfmesh.sizing.rules.rule."""

class CallbackPlaceRule(PlaceRule):
    def __init__(self, rule: object) -> None:
        """rule: a PlaceRule of surfmesh.sizing.rules.rule."""

class SizeRules:
    """All rules that hold on one surface."""

    def __init__(self, by_curvature: Sequence[CurvatureRule], by_place: Sequence[PlaceRule], clamp: tuple[float, float], longest: float, anisotropy: float) -> None:
        """
        clamp: the smallest and the largest size. longest: the largest along the longer axis of an anisotropic metric. anisotropy: largest ratio of two sizes.
        """

FINEST_SIZE: float = 1e-05

FINEST_BY_ANGLE: float = 0.0002

DEFAULT_MAX_SIZE: float = 0.1

LONGEST_SIZE: float = 1.0

class StatedBounds:
    """What bounds of sizes are asked for, model units."""

    def __init__(self, *, min_size: float | None, max_size: float | None, size: float | None, has_size: bool, is_anisotropic: bool) -> None:
        """size: the same everywhere. has_size: that, or a law of sizes."""

class SizeBounds:
    """What the least of all rules is kept within."""

    @property
    def smallest(self) -> float: ...

    @property
    def largest(self) -> float:
        """It may be infinite."""

    @property
    def longest(self) -> float:
        """Along the longer axis of an anisotropic metric."""

    @property
    def default_largest(self) -> float | None:
        """Where none is stated; the smallest size may be larger."""

def size_bounds(stated: StatedBounds, diagonal: float) -> SizeBounds:
    """On a surface whose bounding box has this diagonal, model units."""

class AskedRules:
    """What is asked for on any surface, the same in all directions."""

    def __init__(self, by_curvature: Sequence[CurvatureRule], on_lattice: Sequence[CurvatureRule], by_place: Sequence[PlaceRule], bounds: StatedBounds) -> None:
        """
        At least one rule. on_lattice: those by curvature for triangles that form a lattice; none where they may not.
        """

class SizeLimits:
    """Upper bounds of the size near points."""

    def __init__(self, points: Annotated[NDArray[numpy.float64], dict(shape=(None, 3), order='C', device='cpu', writable=False)], sizes: Annotated[NDArray[numpy.float64], dict(shape=(None,), order='C', device='cpu', writable=False)], slope: float, metric_root_3d: Annotated[NDArray[numpy.float64], dict(shape=(None, 6), order='C', device='cpu', writable=False)] | None = None) -> None:
        """
        points (k, 3), sizes (k,), metric_root_3d (k, 6) or None, for every direction.
        """

    def at(self, points: Annotated[NDArray[numpy.float64], dict(shape=(None, 3), order='C', device='cpu', writable=False)]) -> Annotated[NDArray[numpy.float64], dict(shape=(None,))]:
        """Largest size (n,) at points (n, 3)."""

    def along(self, points: Annotated[NDArray[numpy.float64], dict(shape=(None, 3), order='C', device='cpu', writable=False)], directions: Annotated[NDArray[numpy.float64], dict(shape=(None, None, 3), order='C', device='cpu', writable=False)]) -> Annotated[NDArray[numpy.float64], dict(shape=(None, None))]:
        """Largest sizes (k, n) at points (n, 3) in k unit directions (k, n, 3)."""

    def tightest(self, points: Annotated[NDArray[numpy.float64], dict(shape=(None, 3), order='C', device='cpu', writable=False)], normals: Annotated[NDArray[numpy.float64], dict(shape=(None, 3), order='C', device='cpu', writable=False)]) -> tuple[Annotated[NDArray[numpy.float64], dict(shape=(None,))], Annotated[NDArray[numpy.float64], dict(shape=(None, 3))]]:
        """
        The smallest size (n,) in any direction of the tangent planes at points (n, 3) with unit normals (n, 3), and a unit direction (n, 3) it holds in.
        """

class SurfaceLaw(surfmesh._core.fields.NodeLaw):
    """Ungraded target sizes on one surface."""

    def __init__(self, surface: surfmesh._core.surfaces.Surface, chart: surfmesh._core.surfaces.Chart, rules: SizeRules, rims: tuple[float, Sequence[bool], SizeLimits | None] | None = None, limits: tuple[SizeLimits, float, bool] | None = None) -> None:
        """
        rims: chord, which sides of the rectangle are open, limits near trimming loops or None. limits: of edges or earlier rounds, what none goes below, and whether sizes within them count as asked for.
        """

    def nodes(self, xy: Annotated[NDArray[numpy.float64], dict(shape=(None, 2), order='C', device='cpu', writable=False)]) -> tuple:
        """The twelve arrays of FieldNodes at xy (n, 2) of the chart."""

class StretchedLaw(SurfaceLaw):
    """The same where sizes depend on the direction."""

    def __init__(self, surface: surfmesh._core.surfaces.Surface, chart: surfmesh._core.surfaces.Chart, rules: SizeRules, rims: tuple[float, Sequence[bool], SizeLimits | None] | None = None, limits: tuple[SizeLimits, float, bool] | None = None, even: bool = False) -> None:
        """Likewise. even: the curvatures are known to be the same everywhere."""

BENDING: float = 0.7

FANNING: float = 0.29

ROUND: float = 1.5

def limit_longer_sizes(builder: surfmesh._core.fields.FieldBuilder, law: StretchedLaw, chord: float) -> tuple[str, tuple[float, float], float]:
    """
    Lower long sizes of a refined field where directions change, and raise short ones where long ones are not reached; returned as by FieldBuilder.refine.
    """

def direction_rates(surface: surfmesh._core.surfaces.Surface, uv: Annotated[NDArray[numpy.float64], dict(shape=(None, 2), order='C', device='cpu', writable=False)], size: Annotated[NDArray[numpy.float64], dict(shape=(None,), order='C', device='cpu', writable=False)], along_first: Annotated[NDArray[numpy.uint8], dict(shape=(None,), order='C', device='cpu', writable=False)]) -> Annotated[NDArray[numpy.float64], dict(shape=(None, 2))]:
    """
    |K_t| and |k_n| (n, 2), 1 / model unit^2, at uv (n, 2); zero where they are not known.

    size (n,): a length. along_first (n,): is t the first principal direction?
    """

def longest_along(rates: Annotated[NDArray[numpy.float64], dict(shape=(None, 2), order='C', device='cpu', writable=False)], k1: Annotated[NDArray[numpy.float64], dict(shape=(None,), order='C', device='cpu', writable=False)], k2: Annotated[NDArray[numpy.float64], dict(shape=(None,), order='C', device='cpu', writable=False)], size: Annotated[NDArray[numpy.float64], dict(shape=(None,), order='C', device='cpu', writable=False)], chord: float) -> Annotated[NDArray[numpy.float64], dict(shape=(None,))]:
    """
    Largest length (n,) of triangles that are size (n,) wide, at rates (n, 2); at least that.
    """

LEAST_ROWS: float = 24.0

def keeps_lattice(surface: surfmesh._core.surfaces.Surface, extent: tuple[float, float], rules: SizeRules, slope: float) -> bool:
    """
    Does a lattice of triangles, laid along principal directions at one place, lie so everywhere?

    extent: of the surface's chart. rules: for such a lattice. slope: growth of sizes per length at most.
    """

class BoundedFeatures(surfmesh._core.fields.HiddenFeatures):
    """Features between samples, where derivatives are bounded."""

    def __init__(self, law: SurfaceLaw, angle: float | None, chord: float | None) -> None:
        """
        angle (degrees), chord (model units): what is asked for. What rises or turns less than a fraction of these within a narrow or deep cell is no feature.
        """
