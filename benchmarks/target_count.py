"""The sizes that give a mesh of a wanted number of triangles: a secant iteration.

The chord error is what a user turns, so it is what is turned here: log(count) is close to
linear in log(chord). Where the count no longer answers to the chord something else decides.
Too many triangles: the default limit on the angle between neighbours, which is then raised to
90 degrees. Too few: the largest size, as on a plane, which then gets a uniform edge length.
"""

import math
from collections.abc import Callable

import numpy as np

import surfmesh as sm
from surfmesh.geometry.parameter_grid import parameter_grid
from surfmesh.geometry.surface import Surface

TOLERANCE = 0.04  # relative, of the count
MOST_TRIALS = 14
DEAF = 0.15  # slope of log(count) by log(chord) below which the chord is not what decides
NEAR_ENOUGH = 0.12  # relative: when the chord is deaf, a count this near is taken
LARGEST_ANGLE = 90.0  # degrees


def diagonal(surface: Surface) -> float:
    """Of the bounding box of a grid of points."""
    (points,) = surface.evaluate(parameter_grid(surface.domain, 33), 0)
    return float(np.linalg.norm(np.ptp(points, axis=0)))


def triangle_count(surface: Surface, optimise: bool = True) -> Callable[[dict], int]:
    return lambda sizing: len(sm.mesh(surface, sm.Sizing(**sizing), optimise=optimise).triangles)


def node_count(surface: Surface, optimise: bool = True) -> Callable[[dict], int]:
    return lambda sizing: len(sm.mesh(surface, sm.Sizing(**sizing), optimise=optimise).points)


def sizing_for(
    surface: Surface,
    wanted: int,
    growth: float,
    count: Callable[[dict], int] | None = None,
    tolerance: float = TOLERANCE,
    start: tuple[dict, int] | None = None,
) -> dict:
    """Keyword arguments of ``Sizing`` that give about ``wanted`` triangles.

    count: what is counted, triangles if it is not given. start: a sizing that this function
    has found before, with the number it was for.
    """
    count = count or triangle_count(surface)
    extent = diagonal(surface)
    search = _Search(count, wanted, tolerance)
    if start is not None and start[1] < wanted:  # a finer mesh: the chord decides again
        found, number = start
        option = "size" if "size" in found else "chord"
        power = -2.0 if option == "size" else -1.0
        guess = found[option] * (wanted / number) ** (1.0 / power)
        return search.run(option, guess, {"growth": growth}, power)
    if search.run("chord", 1e-3 * extent, {"growth": growth}, -1.0) and not search.deaf:
        return search.sizing
    if abs(search.found / wanted - 1.0) < NEAR_ENOUGH:
        return search.sizing
    if search.found < wanted:
        edge = extent / math.sqrt(wanted)
        return search.run("size", edge, {"growth": growth}, -2.0)
    fixed = {"angle": LARGEST_ANGLE, "growth": growth}
    return search.run("chord", search.sizing["chord"], fixed, -1.0)


class _Search:
    """Secant iterations on the logarithms of one option and the count."""

    def __init__(self, count: Callable[[dict], int], wanted: int, tolerance: float) -> None:
        self.count, self.wanted, self.tolerance = count, wanted, tolerance
        self.sizing: dict = {}
        self.found = 0
        self.deaf = False

    def run(self, option: str, value: float, others: dict, slope: float) -> dict:
        """Turn ``option`` from ``value`` on; the sizing whose count is nearest."""
        trials: list[tuple[float, int]] = []
        self.deaf = False
        for _ in range(MOST_TRIALS):
            value = float(f"{value:.5g}")
            trials.append((value, self.count({option: value, **others})))
            value, self.found = min(trials, key=lambda t: abs(math.log(t[1] / self.wanted)))
            self.sizing = {option: value, **others}
            if abs(self.found / self.wanted - 1.0) < self.tolerance:
                break
            if len(trials) > 1 and trials[-1][0] != trials[-2][0]:
                (a, m), (b, n) = trials[-2:]
                slope = math.log(m / n) / math.log(a / b)
                if option == "chord" and slope > -DEAF:
                    self.deaf = True
                    break
            step = math.log(self.wanted / self.found) / min(slope, -DEAF)
            value *= math.exp(min(max(step, -3.0), 3.0))
        return self.sizing
