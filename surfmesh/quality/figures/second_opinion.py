"""What other libraries say of a mesh, figure by figure, beside what the report says."""

from dataclasses import dataclass


@dataclass(frozen=True, kw_only=True)
class OpinionRow:
    """In model units and degrees."""

    whose: str  # "trimesh" or "pyvista"
    quantity: str
    of: str  # "": the whole mesh, else a solid or a triangle
    ours: bool | int | float | None
    theirs: bool | int | float | None
    tolerance: float | None  # what rounding can make of it; None: the two must be equal
    agree: bool | None  # None: not compared
    note: str  # why it is not


@dataclass(frozen=True, kw_only=True)
class SecondOpinion:
    """What trimesh and PyVista say of the mesh, figure by figure."""

    compared: int  # rows where there is something to compare
    agreed: int  # of these
    rows: tuple[OpinionRow, ...]

    @property
    def disagreements(self) -> tuple[OpinionRow, ...]:
        """The rows that do not agree."""
        return tuple(row for row in self.rows if row.agree is False)


def figure_in_words(value: bool | int | float | None) -> str:
    """A figure with all its digits, yes or no, or a dash."""
    if isinstance(value, bool):
        return "yes" if value else "no"
    if value is None:
        return "-"
    return repr(value) if isinstance(value, float) else f"{value:,}"
