"""What the user asks for: one frozen set of options."""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, fields, replace
from functools import wraps
from numbers import Real
from typing import Any, TypeVar

import numpy as np

from surfmesh.errors import SizingError, did_you_mean, shown
from surfmesh.sizing.options.other_words import own_word
from surfmesh.sizing.options.positive import positive
from surfmesh.sizing.options.size_laws import checked_sizes
from surfmesh.sizing.options.sources import source_sizes
from surfmesh.truth_value import is_truth_value, truth_value

MOST_STRETCHED = 1e6
"""Largest ratio of two sizes: beyond it areas are round-off."""

FEWEST = 4
"""Triangles that may be asked for: those of a tetrahedron."""

ON_SURFACE, BALANCED = "on_surface", "balanced"
"""Where vertices lie."""

SizeLaw = Callable[[np.ndarray], np.ndarray]
_Options = TypeVar("_Options")


def _with_known_names(options: type[_Options]) -> type[_Options]:
    """A dataclass that says in one line what is wrong with the name of an option."""
    made = options.__init__

    @wraps(made)
    def __init__(self: _Options, *args: Any, **given: Any) -> None:
        if args:
            raise SizingError("sizes are given by name, as in Sizing(chord=0.01), Sizing(size=0.1)")
        require_known(given)
        made(self, **given)

    options.__init__ = __init__  # type: ignore[assignment, method-assign]  # says more
    return options


@_with_known_names
@dataclass(frozen=True, kw_only=True)
class Sizing:
    """The wanted mesh. All lengths are in model units, all options hold at once.

    How near: ``chord``, ``angle``, ``volume``, ``proof``. How long: ``size``, ``min_size``,
    ``max_size``, ``sources``, ``gap``, ``gap_faces``. How they change: ``growth``, ``anisotropy``.
    How many: ``triangles``, ``fewest``, ``limit``. Of what kind: ``order``, ``vertices``. Each has
    its own lines where it is defined, and in docs/sizing.md.

    With nothing given the size follows from the surface: a chord error of a thousandth of its
    diagonal, at most a tenth of the diagonal. Raises ``SizingError`` for one that is not a
    positive number, or that contradicts another.
    """

    chord: float | None = None
    """Largest distance between mesh and surface, model units. It holds both ways: of the mesh from
    the surface, and of the surface from the mesh, its free rims included."""

    angle: float | None = None
    """Largest angle between the normals of two triangles of one face that share an edge, degrees:
    measured on the mesh, and made finer until it holds. Left out are the places where the surface
    itself bends, creases and apexes. When only ``chord`` is given sizes follow a rule of 45
    degrees, as a coarser mesh would fold; that is no promise."""

    size: float | SizeLaw | None = None
    """Wanted edge length: a number, or a callable of points (n, 3) -> (n,)."""

    min_size: float | None = None
    """No wanted edge length is smaller than this (accuracy yields to it)."""

    max_size: float | None = None
    """No wanted edge length is larger than this."""

    growth: float = 1.2
    """Largest ratio of neighbouring sizes, along any edge of the mesh; above 1."""

    anisotropy: float = 1.0
    """Largest ratio of the sizes along the two principal directions; 1 is isotropic.

    Above 1 edges may be longer along the direction of low curvature. ``size``, ``min_size`` and
    ``max_size`` hold in every direction; without ``max_size`` the longer one may reach the
    diagonal."""

    volume: float | None = None
    """Largest relative error of the volume of each closed solid of a CAD model, as 0.005: curved
    faces are made finer until it holds, by whatever else they are sized. Nothing is done for
    volumes unasked; the report states their errors."""

    triangles: int | None = None
    """About so many triangles in all, within 5 %: the sizes that nothing else decides are scaled
    until the mesh has them. In place of ``chord``, ``angle``, ``size`` and ``volume``, which say
    how fine the whole is, too."""

    proof: bool = False
    """Prove that ``chord`` holds: triangles that bounds do not show to be near enough are made
    smaller until they do, or the report says which are not proved. See docs/proof.md."""

    fewest: bool = False
    """As few triangles as keep ``chord``, for more time a triangle and a little less shape: sizes
    follow the direction of each triangle's edges, and vertices move to where triangles may stay
    large. Not with an ``angle``, which these moves would undo. See docs/sizing.md."""

    order: int = 1
    """2: quadratic triangles, with nodes amid their edges on the true curves and surfaces. Then
    ``chord`` is the distance of the curved triangles, which are far larger, unless ``anisotropy``,
    ``volume`` or ``proof`` is asked for: these are of straight triangles, and so are sizes then, as
    they are where no ``chord`` is given."""

    vertices: str = ON_SURFACE
    """Where they lie: "on_surface", or "balanced": they move along the normals until the surface
    lies on both sides of the triangles, and closed solids have their exact volumes. ``chord`` holds
    as ever, with fewer triangles where the surface bends one way: about two thirds. Planes stay
    planes, common edges stay common. For volumes, as in neutronics or 3D printing; where nodes have
    to lie on the surface, leave it. Nothing moves in planar domains."""

    sources: tuple[SizeLaw, ...] = ()
    """Local sizes: ``Near``, ``InBall``, ``InBox``, ``SizeCloud``, or callables of points
    (n, 3) -> (n,), infinite where nothing is asked for. The smallest holds."""

    gap: float | None = None
    """At least so many triangles across thin faces, and between near edges of a face. There
    sizes at the edges hold in every direction, whatever ``anisotropy`` is."""

    gap_faces: bool = False
    """Likewise between near faces of a solid; ``gap``, or else 1, says how many."""

    limit: int = 20_000_000
    """A mesh that would have more triangles is refused before it is made."""

    def __post_init__(self) -> None:
        for name in ("chord", "angle", "max_size", "min_size", "volume"):
            value = getattr(self, name)
            if value is not None:
                object.__setattr__(self, name, positive(name, value))
        for name in ("proof", "fewest", "gap_faces"):
            object.__setattr__(self, name, truth_value(name, getattr(self, name)))
        if self.size is not None and not callable(self.size):
            object.__setattr__(self, "size", positive("size", self.size))
        object.__setattr__(self, "growth", positive("growth", self.growth))
        object.__setattr__(self, "anisotropy", positive("anisotropy", self.anisotropy))
        if self.growth <= 1.0:
            raise SizingError(f"growth must be above 1, not {self.growth:g}")
        if self.anisotropy < 1.0:
            raise SizingError(f"anisotropy must be at least 1, not {self.anisotropy:g}")
        if self.anisotropy > MOST_STRETCHED:
            raise SizingError(
                f"anisotropy must be at most {MOST_STRETCHED:g}, not {self.anisotropy:g}"
            )
        sources = (self.sources,) if callable(self.sources) else self.sources
        if not isinstance(sources, (tuple, list)) or not all(map(callable, sources)):
            raise SizingError(
                "sources are Near, InBall, InBox, SizeCloud or callables of points (n, 3), "
                f"not {shown(self.sources)}"
            )
        object.__setattr__(self, "sources", tuple(sources))
        if self.gap is not None:
            object.__setattr__(self, "gap", positive("gap", self.gap))
            if not 1e-3 <= self.gap <= 1000.0:
                raise SizingError(f"gap is a number of triangles, 0.001 to 1000, not {self.gap:g}")
        object.__setattr__(self, "limit", int(positive("limit", self.limit)))
        if self.triangles is not None:
            self._check_triangles()
        if self.volume is not None and self.volume >= 1.0:
            raise SizingError(f"volume is a relative error below 1, not {self.volume:g}")
        self._check_choices()
        self._check_order_of_sizes()

    def _check_choices(self) -> None:
        """What excludes each other of ``order``, ``proof``, ``fewest`` and ``vertices``."""
        object.__setattr__(self, "order", checked_order(self.order))
        if self.proof and self.chord is None and self.triangles is None:
            raise SizingError("proof needs a chord: it is the distance that is to be proved")
        if self.vertices not in (ON_SURFACE, BALANCED):
            known = f"{ON_SURFACE!r} or {BALANCED!r}"
            raise SizingError(f"vertices is {known}, not {shown(self.vertices)}")
        if self.fewest and self.chord is None and self.triangles is None:
            raise SizingError("fewest needs a chord: it is what the triangles are to keep")
        if self.fewest and self.is_curved:
            raise SizingError("fewest is of straight triangles: those of order 2 are few already")
        if self.proof and self.is_balanced:
            raise SizingError("proof needs vertices on the surface: they cannot be balanced too")
        if self.order == 2 and self.is_balanced:
            raise SizingError(
                "nodes of order 2 lie on the surface: vertices cannot be balanced too"
            )

    def _check_order_of_sizes(self) -> None:
        if self.angle is not None and self.angle > 90.0:
            raise SizingError(f"angle must be at most 90 degrees, not {self.angle:g}")
        if self.min_size and self.max_size and self.min_size > self.max_size:
            raise SizingError(
                f"min_size {self.min_size:g} is larger than max_size {self.max_size:g}"
            )
        if isinstance(self.size, float):
            if self.min_size and self.size < self.min_size:
                raise SizingError(f"size {self.size:g} is below min_size {self.min_size:g}")
            if self.max_size and self.size > self.max_size:
                raise SizingError(f"size {self.size:g} is above max_size {self.max_size:g}")

    def _check_triangles(self) -> None:
        asked = positive("triangles", self.triangles)
        if asked != int(asked) or asked < FEWEST:
            raise SizingError(f"triangles is a whole number from {FEWEST}, not {asked:g}")
        object.__setattr__(self, "triangles", int(asked))
        for name in ("chord", "angle", "size", "volume"):
            if getattr(self, name) is not None:
                raise SizingError(f"triangles and {name} both say how fine the mesh is: give one")
        if self.limit < asked:
            count = f"{int(asked):,}" if asked < 1e15 else f"{asked:g}"  # no 300 digits
            raise SizingError(f"triangles {count} is above limit {self.limit:,}")

    @property
    def is_anisotropic(self) -> bool:
        """Do the sizes depend on the direction?"""
        return self.anisotropy > 1.0 and (self.chord is not None or self.angle is not None)

    @property
    def is_of_size_alone(self) -> bool:
        """Does nothing but ``size`` and sources say how fine the mesh is?"""
        others = (self.chord, self.angle, self.volume, self.triangles)
        return self.size is not None and all(other is None for other in others)

    @property
    def uses_evenly(self) -> bool:
        """Do triangles share ``chord`` evenly? Not where they keep an ``angle`` too, nor stretched
        ones that leave the surface: both would be undone."""
        is_undone = self.angle is not None or (self.is_anisotropic and self.is_balanced)
        return self.fewest and self.chord is not None and not is_undone

    @property
    def is_evened(self) -> bool:
        """Do stretched triangles?"""
        return self.uses_evenly and self.is_anisotropic

    @property
    def is_curved(self) -> bool:
        """Is ``chord`` that of quadratic triangles, and not of the straight ones between their
        corners?"""
        of_straight = self.is_anisotropic or self.volume is not None or self.proof
        return self.order == 2 and self.chord is not None and not of_straight

    @property
    def straight_chord(self) -> float | None:
        """``chord`` where it is that of straight triangles."""
        return None if self.is_curved else self.chord

    @property
    def is_balanced(self) -> bool:
        """Do vertices move off the surface?"""
        return self.vertices == BALANCED

    @property
    def gradient(self) -> float:
        """Largest slope of the size along the surface that keeps to ``growth``.

        Two touching circles of sizes h and g h lie (1 + g) h / 2 apart.
        """
        return 2.0 * (self.growth - 1.0) / (self.growth + 1.0)

    @property
    def largest_stated(self) -> float | None:
        """The number that no wanted edge length may exceed; None where none is given."""
        stated = [size for size in (self.max_size, self.size) if isinstance(size, float)]
        return min(stated) if stated else None

    @property
    def has_law(self) -> bool:
        """Do sizes depend on the place by a law or by sources?"""
        return callable(self.size) or bool(self.sources)

    def law_sizes(self, points: np.ndarray) -> np.ndarray:
        """What the law and the sources ask for (n,) at points (n, 3); infinite for nothing.

        Raises ``SizingError`` when one of them gives anything else than positive numbers.
        """
        sizes = source_sizes(self.sources, points)
        if callable(self.size):
            np.minimum(sizes, checked_sizes(self.size, points, "size"), out=sizes)
        return sizes

    @property
    def law_slope(self) -> float:
        """How fast laws and sources change at most; of callables nobody knows: ``gradient``."""
        slopes = [getattr(source, "slope", self.gradient) for source in self.sources]
        return max([self.gradient, *slopes])

    def replaced(self, **changes: Any) -> "Sizing":
        """A copy with some options changed."""
        return replace(self, **changes)

    @classmethod
    def of(cls, given: "Sizing | float | SizeLaw | Mapping | None") -> "Sizing":
        """Sizing from what a user may pass: itself, a bare number, a mapping, or nothing."""
        if given is None:
            return cls()
        if isinstance(given, cls):
            return given
        if isinstance(given, Mapping):
            require_known(given)
            return cls(**given)
        if isinstance(given, (int, float)) or callable(given):
            return cls(size=given)
        raise SizingError(f"sizes are a number, a Sizing or a mapping, not {type(given).__name__}")


def checked_order(order: Any) -> int:
    """1 or 2 as an int. Raises ``SizingError`` for anything else."""
    is_number = isinstance(order, Real) and not is_truth_value(order)
    if not is_number or order not in (1, 2):
        raise SizingError(f"order is {shown(order)}: meshes are of order 1 or 2")
    return int(order)


def require_known(given: Mapping[Any, Any], beside: Sequence[str] = ()) -> None:
    """Raises ``SizingError`` for a name that is no option, with ours for other programs' words.

    beside: what else the caller takes by name, which may have been meant.
    """
    known = sorted(option.name for option in fields(Sizing))
    for name in given:
        if name in known:
            continue
        word = own_word(name) if isinstance(name, str) else None
        if word is not None:
            raise SizingError(f"unknown size option {shown(name)}: here it is called {word!r}")
        near = did_you_mean(str(name), (*known, *beside)) or f"; known are {', '.join(known)}"
        raise SizingError(f"unknown size option {shown(name)}{near}")
