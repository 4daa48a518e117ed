"""The rows of one library: its figures beside ours, and whether they agree."""

import math
from typing import Any

from surfmesh.quality.figures.second_opinion import OpinionRow
from surfmesh.quality.opinion.libraries_asked import Failed

NO_ANSWER = "no answer: "
"""How the note of a row starts whose library raised."""


class Witness:
    """One library and its rows. ``theirs`` may be ``Failed``, or None where nothing was asked."""

    def __init__(self, whose: str, exponent: int, unmeasured: str) -> None:
        """exponent: their unit of length is 2**exponent; unmeasured: why no lengths, areas and
        volumes are compared, if they are not.
        """
        self.whose, self.exponent, self.unmeasured = whose, exponent, unmeasured
        self.rows: list[OpinionRow] = []

    def same(
        self, quantity: str, ours: bool | int, theirs: Any, of: str = "", reason: str = ""
    ) -> None:
        """A row that must be equal; reason: why it cannot be compared."""
        if isinstance(theirs, Failed):
            theirs, reason = None, NO_ANSWER + theirs.reason
        agree = None if reason else bool(ours == theirs)
        self._add(quantity, of, ours, theirs, None, agree, reason)

    def near(
        self,
        quantity: str,
        ours: float | None,
        theirs: Any,
        bound: float,
        power: int,
        of: str = "",
        reason: str = "",
    ) -> None:
        """A row that may differ by ``bound``, which is in their units as ``theirs`` is: of a
        length to the ``power``.
        """
        reason = self.unmeasured or reason
        if isinstance(theirs, Failed):
            theirs, reason = None, NO_ANSWER + theirs.reason
        if theirs is not None:
            theirs = math.ldexp(theirs, power * self.exponent)
        if reason or ours is None:
            self._add(quantity, of, ours, theirs, None, None, reason or "the report has none")
            return
        tolerance = math.ldexp(bound, power * self.exponent)
        agree = bool(abs(theirs - ours) <= tolerance)  # not so for nan
        self._add(quantity, of, ours, theirs, tolerance, agree, "")

    def _add(self, quantity: str, of: str, ours: Any, theirs: Any, *rest: Any) -> None:
        tolerance, agree, note = rest
        self.rows.append(
            OpinionRow(
                whose=self.whose, quantity=quantity, of=of, ours=ours, theirs=theirs,
                tolerance=tolerance, agree=agree, note=note,
            )
        )  # fmt: skip
