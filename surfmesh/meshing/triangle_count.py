"""Sizes for a wanted number of triangles: all are scaled by one factor until the mesh has it.

chord, max_size of the defaults, scaled
  estimate -> estimate -> mesh, and mesh again where its count is off      count ~ 1 / scale^2

    count  |  +-- trials                 details vanish at some chord, and thousands of triangles
     above |  x                          with them: there the chord stays where they have vanished,
    wanted |- - -x.- - - - - - -         and sizes alone go down again
     below |       x  <- from here
           +--------------- scale
"""

import math
from collections.abc import Callable
from itertools import pairwise
from typing import NamedTuple

from surfmesh.errors import MeshingError, SizingError
from surfmesh.result.surface_mesh import SurfaceMesh
from surfmesh.sizing.options.defaults import DEFAULT_CHORD, default_max_size
from surfmesh.sizing.options.sizing import Sizing

NEAR = 0.02
"""An estimate this near to what is wanted, relatively, is near enough: they are no nearer to the
mesh themselves."""

ROUGHLY, SMALL = 0.3, 5_000
"""As near is enough for up to so many triangles: meshes are made of them as fast as estimates."""

PROMISED = 0.05
"""So near the mesh comes, relatively, or says that it does not."""

AIMED = 0.6 * PROMISED
"""A mesh this near is not made again."""

ESTIMATES, MESHES, SMALL_MESHES = 14, 5, 14
"""So many are made at most; the last of up to ``FEW`` triangles."""

FEW = 20_000

LARGEST_STEP = 4.0
"""Factor on the scale of one step, at most."""

COARSEST = 32.0
"""The largest scale: the chord is the diagonal then. Larger ones mean nothing."""

DEAF, DEAF_STEP, WIDE_STEP = 0.005, 2.0, 1.5
"""Where the count changes by less, relatively, in one step the next one is so large at least; and
where the step was as large as the last of these, ``min_size`` decides the count if there is one."""

FAILED, FAILURES = 0.5, 3
"""Triangles of a trial that gives no mesh: sizes were too coarse for one. Where so many of the
first do there is none."""

NARROW_STEP = 0.02
"""Logarithm of a step in which the count jumps over what is wanted."""

TRIALS_BETWEEN = 3
"""So many between two scales, one with too many triangles and one with too few, until it is taken
for a jump."""

ROOM = 4
"""Times the triangles that are wanted a trial may have, whatever the limit."""

LEAST_SHIFT = 0.1
"""Of the way between two scales is made at least where the first trial there did not do."""

SQUARE, LEAST_POWER = -2.0, -0.5
"""Powers of the scale that counts go with: as a rule, and where steps would be too long."""

LEAST_STEP = 1.01
"""Factor on the scale."""


class Scales(NamedTuple):
    """Factors on the default sizes."""

    chord: float
    """The chord goes with its square: so all sizes that follow from it are scaled alike."""
    size: float
    """Of ``max_size``."""


class _Trial(NamedTuple):
    scale: float
    """Of the sizes."""
    found: float
    """Triangles."""


class _Search:
    """Scales one after the other, each by what those before it have given."""

    def __init__(self, wanted: int, start: Scales, has_floor: bool) -> None:
        """has_floor: sizes have a lower bound, beyond which finer ones are none."""
        self.wanted, self.has_floor = wanted, has_floor
        self.best, self.nearest = start, math.inf
        self.next: Scales | None = start
        """What is to be tried; None where nothing is left."""
        self._chord = None if start.chord == start.size else start.chord  # held there
        self._line: list[_Trial] = []  # with this chord, rising
        self._between = self._beside = 0
        self._ended = ""

    @property
    def reason(self) -> str:
        """Why nothing nearer was found."""
        ended = self._ended or "no sizes that were tried come nearer"
        return f"{ended}; boundaries, details and the other sizes asked for decide"

    def run(self, count: Callable[[Scales], float], most: int, near: float) -> None:
        """Try ``most`` scales, until one is ``near`` enough, relatively. Raises what the last one
        raised where all failed."""
        failure: MeshingError | None = None
        failures = 0
        for _ in range(most):
            if self.next is None or self.nearest < math.log1p(near):
                break
            try:
                found = max(count(self.next), 1.0)
            except MeshingError as error:
                failure, found = error, FAILED
                failures += 1
                if math.isinf(self.nearest) and failures == FAILURES:
                    break
            self._take(self.next, found)
        if failure is not None and math.isinf(self.nearest):
            raise failure

    def _take(self, scales: Scales, found: float) -> None:
        off = abs(math.log(found / self.wanted))
        if off < self.nearest and found > FAILED:
            self.best, self.nearest = scales, off
        self._line = sorted([*self._line, _Trial(scales.size, found)])
        scale = self._next_scale()
        held = self._chord
        self.next = None if scale is None else Scales(held or scale, scale)

    def _next_scale(self) -> float | None:
        above = [trial.found > self.wanted for trial in self._line]
        if all(above):
            return self._coarser()
        if not any(above):
            return self._finer()
        pairs = [pair for k, pair in enumerate(pairwise(self._line)) if above[k] != above[k + 1]]
        one, other = min(pairs, key=lambda pair: self._off(pair[0]) + self._off(pair[1]))
        step = math.log(other.scale / one.scale)
        if min(one.found, other.found) <= FAILED and step >= NARROW_STEP:
            return math.sqrt(one.scale * other.scale)
        if step < NARROW_STEP or self._between >= TRIALS_BETWEEN:
            return self._with_sizes_alone(one, other)
        part = math.log(one.found / self.wanted) / math.log(one.found / other.found)
        least = LEAST_SHIFT if self._between else 0.0
        self._between += 1
        return one.scale * math.exp(step * min(max(part, least), 1.0 - least))

    def _off(self, trial: _Trial) -> float:
        return abs(math.log(trial.found / self.wanted))

    def _coarser(self) -> float | None:
        last, top = self._line[-1], COARSEST if self._chord is None else self._chord
        if last.scale < top:
            return min(last.scale * self._step(self._line[-2:]), top)
        if self._chord is None:
            return self._fewer()
        self._chord, self._line = None, [last]  # this one is of both kinds
        return self._coarser()

    def _fewer(self) -> float | None:
        """Beside the trial with the fewest, where the coarsest sizes give too many: coarser sizes
        do not always give fewer."""
        self._beside += 1
        at = min(range(len(self._line)), key=lambda k: self._line[k].found)
        pairs = [pair for pair in pairwise(self._line) if self._line[at] in pair]
        if not pairs:
            return 0.5 * self._line[at].scale
        if self._beside > TRIALS_BETWEEN:
            self._ended = "the coarsest sizes that were tried give no fewer"
            return None
        one, other = max(pairs, key=lambda pair: pair[1].scale / pair[0].scale)
        return math.sqrt(one.scale * other.scale)

    def _finer(self) -> float | None:
        first = self._line[0]
        if self.has_floor and len(self._line) > 1:
            second = self._line[1]
            wide = second.scale >= WIDE_STEP * first.scale
            if wide and abs(math.log(first.found / second.found)) < DEAF:
                self._ended = "no finer sizes give more"
                return None
        return first.scale / self._step(self._line[:2])

    def _step(self, last: list[_Trial]) -> float:
        """Factor on the scale by the secant of the logarithms, above 1. Where the count hardly
        changes each step is twice as long as the one before."""
        nearest, power, least = min(last, key=self._off), SQUARE, LEAST_STEP
        if len(last) == 2:
            one, other = last
            ratio, change = other.scale / one.scale, math.log(other.found / one.found)
            slope = change / math.log(ratio)
            power = min(max(slope, 2.0 * SQUARE), LEAST_POWER)
            if slope > LEAST_POWER:
                least = max(least, ratio**2, DEAF_STEP if abs(change) < DEAF else 0.0)
        step = math.exp(self._off(nearest) / -power)
        return min(max(step, least), LARGEST_STEP)

    def _with_sizes_alone(self, one: _Trial, other: _Trial) -> float | None:
        """Where the count jumps from one to the other: the chord stays at that of the fewer."""
        fewer, more = sorted((one, other), key=lambda trial: trial.found)
        if fewer.found <= FAILED:
            self._ended = "coarser sizes give no mesh"
            return None
        if self._chord is not None or self.nearest < math.log1p(PROMISED):
            self._ended = f"the number jumps there, from {more.found:,.0f} to {fewer.found:,.0f}"
            return None
        self._chord, self._line, self._between = fewer.scale, [fewer], 0
        return self._finer()


def sizing_for_count(
    sizing: Sizing, diagonal: float, count: Callable[[Sizing], float]
) -> tuple[Sizing, Scales]:
    """The sizes that ``count`` says give ``sizing.triangles``, and their scales.

    diagonal: of the bounding box, model units. count: triangles that sizes would give.
    """
    scales = _estimated(sizing, diagonal, count, NEAR)
    return _scaled(sizing, diagonal, scales), scales


def _estimated(
    sizing: Sizing, diagonal: float, count: Callable[[Sizing], float], near: float
) -> Scales:
    search = _Search(_wanted(sizing), Scales(1.0, 1.0), sizing.min_size is not None)
    search.run(lambda scales: count(_scaled(sizing, diagonal, scales)), ESTIMATES, near)
    return search.best


def mesh_with_count(
    sizing: Sizing,
    diagonal: float,
    count: Callable[[Sizing], float],
    mesh: Callable[[Sizing], SurfaceMesh],
) -> SurfaceMesh:
    """The mesh that has ``sizing.triangles`` within 5 %, or as nearly as can be: it warns then.

    count: triangles that sizes would give, about. mesh: of these sizes.
    """
    wanted = _wanted(sizing)
    near = ROUGHLY if wanted <= SMALL else NEAR
    start = _estimated(sizing, diagonal, count, near)
    search = _Search(wanted, start, sizing.min_size is not None)
    meshes: list[SurfaceMesh] = []

    def made(scales: Scales) -> float:
        found = mesh(_scaled(sizing, diagonal, scales))
        meshes.append(found)
        meshes.sort(key=lambda one: (len(one.triangles) > sizing.limit, _off(one, wanted)))
        del meshes[1:]  # the nearest is kept
        return len(found.triangles)

    search.run(made, SMALL_MESHES if wanted <= FEW else MESHES, AIMED)
    best = meshes[0]
    if len(best.triangles) > sizing.limit:
        raise SizingError(
            f"no sizes were found that give {wanted:,} triangles and no more than the limit of "
            f"{sizing.limit:,}: raise limit, or ask for fewer"
        )
    if _off(best, wanted) <= math.log1p(PROMISED):
        return best
    return best.with_warnings(
        f"{len(best.triangles):,} triangles, where {wanted:,} were asked for: {search.reason}"
    )


def _wanted(sizing: Sizing) -> int:
    if sizing.triangles is None:
        raise SizingError("no number of triangles is asked for")
    return sizing.triangles


def _off(mesh: SurfaceMesh, wanted: int) -> float:
    """Logarithm of the ratio, without its sign."""
    return abs(math.log(max(len(mesh.triangles), 1) / wanted))


def _scaled(sizing: Sizing, diagonal: float, scales: Scales) -> Sizing:
    """The default sizes times ``scales``, within the other sizes asked for."""
    scaled = sizing.replaced(
        triangles=None,
        chord=DEFAULT_CHORD * diagonal * scales.chord**2,
        limit=max(sizing.limit, ROOM * _wanted(sizing)),
    )
    largest = default_max_size(scaled, diagonal, scales.size)
    return scaled.replaced(max_size=min(largest, sizing.max_size or math.inf))
