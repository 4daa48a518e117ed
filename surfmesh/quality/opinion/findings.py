"""What the second opinion says of a mesh, in sentences."""

from collections.abc import Callable, Iterable, Iterator
from dataclasses import dataclass

from surfmesh.quality.figures.second_opinion import OpinionRow, SecondOpinion, figure_in_words
from surfmesh.quality.measures.places import more_in_words
from surfmesh.quality.opinion.witness import NO_ANSWER
from surfmesh.quality.verdict.finding import Kind, Problem, Remark


@dataclass(frozen=True, kw_only=True)
class Disagreement(Problem):
    """A figure on which a library disagrees by more than rounding."""

    kind: Kind = Kind.SECOND_OPINION
    rows: tuple[OpinionRow, ...]  # of one figure and one library

    @property
    def text(self) -> str:
        """The first row, and how many more there are."""
        row = self.rows[0]
        of = f" of {row.of}" if row.of else ""
        near = "" if row.tolerance is None else f", rounding is below {row.tolerance:.2g}"
        return (
            f"second opinion: {row.quantity}{of} is {figure_in_words(row.ours)} in the report and "
            f"{figure_in_words(row.theirs)} by {row.whose}{near}"
            + more_in_words(self.rows, "; and {} more of this kind")
        )


@dataclass(frozen=True, kw_only=True)
class Unanswered(Remark):
    """A library raised."""

    kind: Kind = Kind.SECOND_OPINION
    rows: tuple[OpinionRow, ...]  # of one library and one reason

    @property
    def text(self) -> str:
        """On which figures, and why."""
        row = self.rows[0]
        others = more_in_words(self.rows, " and {} more")
        reason = row.note.removeprefix(NO_ANSWER)
        return f"second opinion: {row.whose} gave none on {row.quantity}{others}: {reason}"


def disagreements(opinion: SecondOpinion) -> Iterator[Problem]:
    """One for each figure of each library."""
    for rows in _grouped(opinion.disagreements, lambda row: row.quantity):
        yield Disagreement(rows=rows)


def unanswered(opinion: SecondOpinion) -> Iterator[Remark]:
    """One for each library that raised, and each reason."""
    raised = (row for row in opinion.rows if row.note.startswith(NO_ANSWER))
    for rows in _grouped(raised, lambda row: row.note):
        yield Unanswered(rows=rows)


def _grouped(
    rows: Iterable[OpinionRow], what: Callable[[OpinionRow], str]
) -> Iterator[tuple[OpinionRow, ...]]:
    """Rows of one library and alike in ``what``, in the order in which the first of each stands."""
    groups: dict[tuple[str, str], list[OpinionRow]] = {}
    for row in rows:
        groups.setdefault((row.whose, what(row)), []).append(row)
    yield from map(tuple, groups.values())
