"""Which numbers can be computed with: the largest and smallest of what is given, with reasons."""

from dataclasses import dataclass


@dataclass(frozen=True)
class NumberRange:
    """What is beyond is refused where it is given, before products of it overflow or vanish."""

    coordinate: float = 1e30
    """Largest, of surfaces, domains and meshes: angles between triangles need squares of products
    of areas, which are eighth powers of edges."""

    extent: float = 1e-30
    """Smallest, of surfaces and domains, for the same reason."""

    speed: float = 1e70
    """Largest first derivative, its inverse the smallest, for the same reason."""

    bend: float = 1e140
    """Largest second derivative, its inverse the smallest; a larger one counts as infinite."""

    parameter: float = 1e100
    """Largest bound of a domain: fourth powers are numbers still."""

    span: float = 1e-100
    """Smallest difference of two bounds, for the same reason."""

    narrow: float = 1e-12
    """Smallest difference over the larger bound: a domain holds 4,500 numbers."""

    size: float = 1e-60
    """Smallest that is asked for: the fourth power of one over it is a number still."""

    square: float = 1e100
    """Largest length or ratio of which no more than squares and inverses are taken."""

    constant: float = 1e300
    """Largest part of a formula: its square root and its neighbours are numbers still."""


RANGE = NumberRange()
