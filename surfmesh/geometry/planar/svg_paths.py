"""Paths of an SVG drawing as polylines."""

from __future__ import annotations

import io
import math
from dataclasses import dataclass
from pathlib import Path
from typing import Any
from xml.etree import ElementTree

import numpy as np

from surfmesh.errors import DomainError, printable
from surfmesh.geometry.boxes import diagonal
from surfmesh.geometry.number_range import RANGE
from surfmesh.geometry.text_file import text_of

DEFAULT_TOLERANCE = 1e-3  # of the diagonal, between a curve and its polyline
MOST_PIECES = 100_000  # of one curve: a tolerance that asks for more is a mistake
MOST_ELEMENTS = 100_000  # of a drawing, each <use> in full
DEEPEST = 100  # elements within each other
LINK = "{http://www.w3.org/1999/xlink}href"
CLOSED = 1e-9  # of the diagonal: ends of a path nearer than this are one point


@dataclass(frozen=True)
class Drawing:
    """What a drawing holds, in its user units, y upwards."""

    name: str
    loops: tuple[np.ndarray, ...]
    """Closed subpaths (k, 2), the first point not repeated."""
    labels: tuple[str, ...]
    """Name of each loop: the element's id or number, and the subpath."""
    lines: tuple[np.ndarray, ...]
    """Open subpaths (k, 2)."""


def svg_paths(source: str | Path, tolerance: float | None = None) -> Drawing:
    """Read a drawing: a file, or text that holds ``<svg``.

    Transformations and basic shapes are resolved; strokes, fills and text are ignored.
    tolerance: largest distance between a curve and its polyline, user units.

    Raises DomainError for a drawing that cannot be read, and for a tolerance that is not a
    positive number or far too small.
    """
    name, text = _opened(source)
    subpaths = _subpaths(name, text)
    for label, segments in subpaths:
        _require_numbers(f"{name}: {label}", segments)
    corners = np.array(
        [_pair(s.end) for _, segments in subpaths for s in segments if s.end is not None]
    ).reshape(-1, 2)
    size = diagonal(corners)
    if tolerance is None:
        tolerance = DEFAULT_TOLERANCE * size
    elif not (tolerance > 0.0 and math.isfinite(tolerance)):
        raise DomainError(f"the tolerance must be a positive number, not {tolerance!r}")
    loops, labels, lines = [], [], []
    for label, segments in subpaths:
        points = _polyline(segments, tolerance, f"{name}: {label}") * (1.0, -1.0)
        if not len(points):
            continue
        shut = any(type(segment).__name__ == "Close" for segment in segments)
        if np.hypot(*(points[-1] - points[0])) <= CLOSED * size:
            points, shut = points[:-1], True
        if not shut:
            lines.append(points)
        elif len(points) > 2:  # a dot or a line to and fro is drawn, but bounds nothing
            loops.append(points)
            labels.append(label)
    return Drawing(name, tuple(loops), tuple(labels), tuple(lines))


def _opened(source: str | Path) -> tuple[str, str]:
    """Name and text of a drawing."""
    if isinstance(source, str) and "<svg" in source:
        return "drawing", source
    path = Path(source)
    return printable(path.stem), text_of(path, DomainError, "an SVG drawing")


def _subpaths(name: str, text: str) -> list[tuple[str, list]]:
    """Labels and segments of all subpaths, transformed, in user units."""
    import svgelements

    try:
        _require_bounded(name, ElementTree.fromstring(text))  # noqa: S314 expat bounds entities
        drawing = svgelements.SVG.parse(io.StringIO(text), reify=True)
        if not isinstance(drawing, svgelements.SVG):
            raise DomainError(f"{name}: not an SVG drawing: its root is no <svg>")
        to_units = _user_units(drawing, svgelements)
        shapes = [e for e in drawing.elements() if isinstance(e, svgelements.Shape)]
        found = []
        for number, element in enumerate(shapes):
            path = abs(svgelements.Path(element) * to_units)
            label = f"path {number}" if element.id is None else f"path {element.id!r:.60}"
            for k, subpath in enumerate(path.as_subpaths()):
                segments = list(svgelements.Path(subpath))
                if any(_drawn(segment) for segment in segments):
                    found.append((f"{label}, subpath {k}", segments))
        return found
    except DomainError:
        raise
    except Exception as error:  # svgelements raises whatever it meets in lengths, styles, units
        reason = " ".join(str(error).split())[:200] or type(error).__name__
        raise DomainError(f"{name}: not an SVG drawing: {reason}") from None


def _require_bounded(name: str, root: ElementTree.Element) -> None:
    """Raise DomainError for elements nested too deep or too many, each <use> in full.

    A few lines of <use> within <use> stand for millions of shapes, or for themselves.
    """
    by_id = {element.get("id"): element for element in root.iter() if element.get("id")}
    waiting, seen = [(root, 0)], 0
    while waiting:
        element, depth = waiting.pop()
        seen += 1
        if depth > DEEPEST or seen > MOST_ELEMENTS:
            limit = f"{DEEPEST} deep" if depth > DEEPEST else f"{MOST_ELEMENTS:,} elements"
            raise DomainError(f"{name}: the drawing goes beyond {limit}, each <use> in full")
        waiting += [(child, depth + 1) for child in element]
        if element.tag.rpartition("}")[2] == "use":
            reference = element.get(LINK) or element.get("href") or ""
            used = by_id.get(reference.lstrip("#"))
            if used is not None:
                waiting.append((used, depth + 1))


def _user_units(drawing: Any, svgelements: Any) -> Any:
    """Undo what width, height and viewBox of the drawing do to its user units."""
    matrix = svgelements.Matrix(drawing.viewbox_transform or "")
    return ~matrix if matrix.determinant else svgelements.Matrix()


def _pair(point: Any) -> tuple[float, float]:
    return float(point.x), float(point.y)


def _drawn(segment: Any) -> bool:
    return type(segment).__name__ != "Move"


def _require_numbers(label: str, segments: list) -> None:
    """Raise DomainError for numbers that are not finite, or whose squares are not."""
    for segment in segments:
        if segment.end is None or type(segment).__name__ == "Close":
            continue
        numbers = _numbers(segment)
        if not all(math.isfinite(x) for x in numbers):
            raise DomainError(f"{label}: has a number that is not finite")
        if any(abs(x) > RANGE.square for x in numbers):
            raise DomainError(f"{label}: has a number beyond {RANGE.square:g}: scale the drawing")


def _polyline(segments: list, tolerance: float, label: str) -> np.ndarray:
    """Points (k, 2) of a subpath, its curves cut to stay within the tolerance."""
    parts = []
    for segment in segments:
        if segment.end is None or type(segment).__name__ == "Close":
            continue
        pieces = _pieces(segment, tolerance)
        if pieces > MOST_PIECES:
            raise DomainError(f"{label}: the tolerance {tolerance:g} is far too small for it")
        if pieces > 1:
            t = np.linspace(0.0, 1.0, pieces + 1)[1:-1]
            parts.append(np.array([_pair(segment.point(x)) for x in t]))
        parts.append(np.array([_pair(segment.end)]))
    points = np.concatenate(parts) if parts else np.empty((0, 2))  # a Z alone
    moved = np.ones(len(points), bool)
    moved[1:] = (np.diff(points, axis=0) != 0.0).any(axis=1)
    return points[moved]


def _numbers(segment: Any) -> list[float]:
    """All that place a segment, as far as it has them."""
    names = ("start", "control", "control1", "control2", "center", "end")
    points = [getattr(segment, name, None) for name in names]
    found = [x for point in points if point is not None for x in _pair(point)]
    if type(segment).__name__ == "Arc":
        found += [float(segment.rx), float(segment.ry), float(segment.sweep)]
    return found


def _pieces(segment: Any, tolerance: float) -> int:
    """Pieces of equal parameter whose chords stay within the tolerance of the curve.

    A curve with |r''| <= m over a parameter step s is at most m s^2 / 8 away from its chord.
    """
    kind = type(segment).__name__
    if kind == "Arc":  # r'' with respect to the angle is the larger radius at most
        bound = max(abs(segment.rx), abs(segment.ry)) * float(segment.sweep) ** 2
    elif kind == "QuadraticBezier":
        a, b, c = (np.array(_pair(p)) for p in (segment.start, segment.control, segment.end))
        bound = 2.0 * np.hypot(*(a - 2.0 * b + c))
    elif kind == "CubicBezier":
        controls = (segment.start, segment.control1, segment.control2, segment.end)
        a, b, c, d = (np.array(_pair(p)) for p in controls)
        bound = 6.0 * max(np.hypot(*(a - 2.0 * b + c)), np.hypot(*(b - 2.0 * c + d)))
    else:
        return 1
    return max(1, math.ceil(math.sqrt(bound / (8.0 * tolerance)))) if bound > 0.0 else 1
