"""Rounds with smaller sizes until nothing is to be mended, or smaller sizes are no help.

limits -> one round: a mesh, and refinements where it is not right yet
  ^                                      |
  +----- joined with what is known ------+     StagnationCheck: do they help at all?
"""

import math
from collections.abc import Callable, Mapping
from typing import TypeVar

MAX_ROUNDS = 8
"""How often everything that depends on refined sizes is done again, at most."""

MAX_ROUNDS_FOR_PROOF = 16
"""The same where the chord is to be proved: bounds are to hold for every triangle."""

MAX_STALLED_ROUNDS = 2
"""A face is meshed again for its own refinements until so many rounds running were stalled."""

STALLED_PLACES, STALLED_TRIANGLES = 0.9, 1.02
"""A round is stalled that has left more than this fraction of the places to be mended, and has less
than so many times the triangles: smaller sizes do not reach what is wrong."""

MAX_ROUNDS_WITHOUT_BEST = 3
"""Or, however much finer it has become, until so many rounds have not left fewer places."""

SPREADING = 1.5
"""Where the segments that cross are so many times more after each round, it is not at a place
that they cross but all along: cutting them finer only makes more of them."""

MAX_BOUNDARY_GROWTH, FEW_BOUNDARY_NODES = 8, 2000
"""A face whose boundary has so many times the nodes that it had at first, and more than so few,
asks for no smaller sizes any more."""

Result = TypeVar("Result")
Bound = TypeVar("Bound")


def refined_in_rounds(
    one_round: Callable[[Mapping[int, Bound]], tuple[Result, Mapping[int, Bound]]],
    joined: Callable[[Bound, Bound | None], Bound],
    rounds: int = MAX_ROUNDS,
    limits: Mapping[int, Bound] | None = None,
) -> Result:
    """The result of the last round.

    one_round: from the limits known so far, by face or solid, to a result and the refinements
    that it asks for; none: it is the last one. joined: a refinement with the limits known before.
    limits: known from the start.
    """
    known = dict(limits or {})
    for _ in range(max(1, rounds)):
        result, refinements = one_round(known)
        if not refinements:
            break
        known = known | {k: joined(more, known.get(k)) for k, more in refinements.items()}
    return result


class StagnationCheck:
    """Whether refinements of a face have helped so far, and have not made it far too large."""

    is_unchanged = False
    """Has the last round left as many places and triangles as the one before?"""
    _stalled = _spreading = _since_best = 0  # rounds running; see ``record``
    _places: float = math.inf
    _best: float = math.inf
    _triangles = _nodes = _first_nodes = 0

    def record(self, places: int, triangles: int, failed: bool = False, nodes: int = 0) -> None:
        """What one round has left: places to be mended, triangles, nodes on the boundary."""
        self.is_unchanged = (places, triangles) == (self._places, self._triangles)
        stalled = (
            places > STALLED_PLACES * self._places
            and triangles < STALLED_TRIANGLES * self._triangles
        )
        self._stalled = self._stalled + 1 if places and stalled and not failed else 0
        spreading = failed and places > SPREADING * self._places
        self._spreading = self._spreading + 1 if spreading else 0
        is_best = not places or failed or places <= STALLED_PLACES * self._best
        self._since_best = 0 if is_best else self._since_best + 1
        self._best = min(self._best, places) if places and not failed else math.inf
        self._places, self._triangles = places, triangles
        self._nodes, self._first_nodes = nodes, self._first_nodes or nodes

    @property
    def is_stalled(self) -> bool:
        """Is another round of no use?"""
        return (
            max(self._stalled, self._spreading) >= MAX_STALLED_ROUNDS
            or self._since_best >= MAX_ROUNDS_WITHOUT_BEST
            or self._nodes > max(MAX_BOUNDARY_GROWTH * self._first_nodes, FEW_BOUNDARY_NODES)
        )
