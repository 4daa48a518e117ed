"""One random thing meshed, judged, and the report's verdict set beside the judge's."""

from __future__ import annotations

import signal
import threading
import warnings
from collections.abc import Callable
from contextlib import contextmanager
from dataclasses import dataclass, field
from random import Random
from time import process_time
from typing import Any

import numpy as np

import surfmesh as sm
from judge import domains, solids, surfaces
from judge.random_domains import RandomDomain, domain_of
from judge.random_parts import sizing_of, valid_part
from judge.random_surfaces import surface_of
from judge.verdict import Verdict

MOST = 60_000  # triangles
STRETCH = (3.0, 5.0, 30.0)
GROWTH = (1.2, 1.3, 1.5)


@dataclass(frozen=True)
class Trial:
    name: str
    outcome: str
    """good; found: at fault, and the report says so; silent: at fault, and the report is clean;
    false alarm: only the report finds fault; refused; late; crashed; warned: a numpy warning."""
    said: tuple[str, ...] = ()
    triangles: int = 0
    seconds: float = 0.0
    figures: dict[str, Any] = field(default_factory=dict)


BAD = ("silent", "false alarm", "crashed", "warned")


def part_trial(seed: int, number: int, limit: float | None = None) -> Trial:
    """Of the part of this number, isotropic where it is even, stretched where it is odd."""
    draw = Random(f"part {seed} {number}")
    part = None
    while part is None:
        part = valid_part(draw)
    sizing = sizing_of(draw, part, stretched=number % 2 == 1)
    euler = solids.euler_of(part.wrapped)

    def judge(mesh: sm.SurfaceMesh) -> Verdict:
        return solids.judged(mesh.points, mesh.triangles, part.wrapped, sizing.chord, euler)

    return _trial(f"part {seed} {number}", part, sizing, judge, limit)


def planar(domain: RandomDomain) -> sm.PlanarDomain:
    outer, holes = domain.loops
    return sm.PlanarDomain(outer, holes, domain.lines, domain.dots)


def domain_trial(seed: int, number: int, limit: float | None = None) -> Trial:
    domain = domain_of(seed, number)
    draw = Random(f"sizes of domain {seed} {number}")
    sizing = sm.Sizing(size=domain.size, growth=draw.choice(GROWTH), limit=MOST)

    def judge(mesh: sm.SurfaceMesh) -> Verdict:
        given = domain.polygon, domain.lines, domain.dots
        return domains.judged(mesh.points, mesh.triangles, *given, touching=domain.touching)

    name = f"domain {seed} {number} ({domain.kind})"
    return _trial(name, lambda: planar(domain), sizing, judge, limit)


def surface_trial(seed: int, number: int, limit: float | None = None) -> Trial:
    kind, truth = surface_of(seed, number)
    draw = Random(f"sizes of surface {seed} {number}")
    sizing = surface_sizing(draw, truth)
    functions = draw.random() < 0.2

    def make() -> Any:
        if functions:
            return sm.NumericSurface(
                lambda u, v: truth.evaluate(np.column_stack([u, v]))[0].T,
                u=truth.u, v=truth.v, loops=truth.loops,
            )  # fmt: skip
        return sm.ParametricSurface(*truth.formulas, u=truth.u, v=truth.v, loops=truth.loops)

    def judge(mesh: sm.SurfaceMesh) -> Verdict:
        return surfaces.judged(mesh.points, mesh.triangles, truth, sizing.chord)

    return _trial(f"surface {seed} {number} ({kind})", make, sizing, judge, limit)


def surface_sizing(draw: Random, truth: surfaces.Truth) -> sm.Sizing:
    """Options drawn at random; chord in most."""
    lines = [np.linspace(*span, 30) for span in (truth.u, truth.v)]
    uv = np.stack(np.meshgrid(*lines), axis=-1).reshape(-1, 2)
    diagonal = float(np.linalg.norm(np.ptp(truth.evaluate(uv)[0], axis=0)))
    asked: dict[str, Any] = {"growth": draw.choice(GROWTH), "limit": MOST}
    if draw.random() < 0.8:
        asked["chord"] = diagonal * 10 ** draw.uniform(-3.3, -1.7)
    else:
        asked["size"] = diagonal * 10 ** draw.uniform(-1.6, -1.0)
    if draw.random() < 0.3:
        asked["angle"] = draw.uniform(5, 40)
    if draw.random() < 0.3:
        drawn = diagonal * draw.uniform(0.03, 0.3)
        asked["max_size"] = max(drawn, asked.get("size", 0.0))  # a size above it is refused
    if draw.random() < 0.3:
        asked["anisotropy"] = draw.choice(STRETCH)
    return sm.Sizing(**asked)


def _trial(
    name: str, thing: Any, sizing: sm.Sizing, judge: Callable[[Any], Verdict], limit: float | None
) -> Trial:
    start = process_time()
    with warnings.catch_warnings(record=True) as warned:
        warnings.simplefilter("always", RuntimeWarning)
        try:
            with _time_limit(limit):
                mesh = sm.mesh(thing() if callable(thing) else thing, sizing)
                report = sm.check(mesh)
        except sm.errors.SurfmeshError as error:
            return Trial(name, "refused", (str(error),), 0, process_time() - start)
        except TimeoutError:
            return Trial(name, "late", (f"not done in {limit} s",), 0, limit or 0.0)
        except Exception as error:
            said = (f"{type(error).__name__}: {error}",)
            return Trial(name, "crashed", said, 0, process_time() - start)
    spent = process_time() - start
    found = judge(mesh)
    problems = () if report.clean else tuple(str(problem) for problem in report.problems)
    outcome = {
        (False, False): "good", (True, True): "found",
        (True, False): "silent", (False, True): "false alarm",
    }[bool(found.faults), not report.clean]  # fmt: skip
    said = tuple(found.faults) + tuple(f"report: {problem}" for problem in problems)
    noise = [str(one.message) for one in warned if "surfmesh" in one.filename]
    if noise and outcome == "good":
        outcome, said = "warned", tuple(noise)
    return Trial(name, outcome, said, len(mesh.triangles), spent, found.figures)


@contextmanager
def _time_limit(seconds: float | None) -> Any:
    """TimeoutError after so many seconds of processor time; only the main thread has alarms."""
    usable = hasattr(signal, "SIGPROF") and threading.current_thread() is threading.main_thread()
    if seconds is None or not usable:
        yield
        return

    def late(*_: object) -> None:
        raise TimeoutError

    before = signal.signal(signal.SIGPROF, late)
    signal.setitimer(signal.ITIMER_PROF, seconds)
    try:
        yield
    finally:
        signal.setitimer(signal.ITIMER_PROF, 0.0)
        signal.signal(signal.SIGPROF, before)
