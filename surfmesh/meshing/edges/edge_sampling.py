"""Samples along the edges of a CAD model, and the edge lengths that they ask for by themselves.

    own curvature, curvature of the faces, size law, sources, length, gaps to other edges of a
    face; each as the sizes of the edge, of its faces and of its vertices have it

Made once for a model. What earlier rounds of meshing have found out, and the growth of sizes
along edges and through vertices, comes later: see ``edge_nodes``.
"""

from collections.abc import Sequence
from typing import NamedTuple, Self
from weakref import WeakKeyDictionary

import numpy as np

from surfmesh._core.edges import gap_sizes
from surfmesh.cad.model.cad_model import CadEdge, CadModel
from surfmesh.cad.model.model_arrays import ModelArrays, model_arrays, offsets
from surfmesh.meshing.edges.edge_mates import NO_RUNS, mate_runs
from surfmesh.meshing.edges.edge_rules import NARROWEST, Courses, EdgeRules
from surfmesh.meshing.edges.edge_samples import EdgeSamples
from surfmesh.meshing.edges.narrow_faces import ROUND, narrow_faces, narrow_width
from surfmesh.sizing.options.model_sizing import ModelSizing
from surfmesh.sizing.options.sizing import Sizing
from surfmesh.sizing.rules.across_gaps import size_across

FEW_SAMPLES, STRAIGHT_SAMPLES, CURVED_SAMPLES = 17, 33, 129
_FEW, _STRAIGHT, _CURVED = (
    np.linspace(0.0, 1.0, n) for n in (FEW_SAMPLES, STRAIGHT_SAMPLES, CURVED_SAMPLES)
)
_OF_KIND = {"line": _FEW, "circle": _STRAIGHT}

LONGER, LEAST_NARROW = 3.0, 0.3
"""Edges narrower than NARROWEST apart ask for so many times their distance, not below this
fraction of NARROWEST: triangles of alpha 0.5."""

SLIVER, PROXIMITY_FLOOR = 5e-5, 1.0 / 150.0
"""Gaps narrower than this fraction of the diagonal, or of the size asked for there without them,
ask for nothing: a sliver along a whole part would flood it with triangles."""

MOST_LONGER = 1e8
"""Segments beside a narrow face are at most so many times longer than it is wide: triangles
longer than that count as having no area."""

HIDDEN, MOST_HALVINGS, MOST_SAMPLES = 0.7, 30, 20_000
"""Between samples, laws may ask for this fraction of the sizes there; how hard that is pursued."""


def sample_edges(model: CadModel, sizing: ModelSizing, few: bool = False) -> EdgeSamples:
    """Samples of all edges. Raises ``SizingError`` for laws that give no sizes.

    few: circles have as many as else straight edges, these half as many: enough for an estimate, as
    they bend evenly.
    """
    rules = EdgeRules(model, sizing)
    arrays = rules.arrays
    places = _places(rules, few)
    courses = Courses.of(arrays, places.edges, places.first, places.fraction)
    total_curvature = np.zeros(len(model.edges))
    total_curvature[places.edges] = courses.total_curvature
    samples = EdgeSamples(
        places.first_of_all,
        places.fraction,
        courses.points,
        rules.target_size(courses),
        courses.tangent if sizing.is_anisotropic else np.empty((0, 3)),
        total_curvature,
        *rules.sags(),
        arrays.has_twin & (total_curvature > 0.0),
        arrays.vertex,
        *arrays.edges_of_faces,
        np.zeros(len(model.faces)),
        {},
        np.zeros(len(model.edges), bool),
        np.zeros(len(model.edges), bool),
        NO_RUNS,
        np.full(len(places.fraction), np.inf),
    )
    _find_narrow(samples, rules)
    samples.mates = mate_runs(model, samples)
    _apply_vertices(samples, rules)
    _apply_gaps(model, samples, sizing)
    return samples


class _Places(NamedTuple):
    """Where edges are sampled."""

    edges: np.ndarray
    """(k,) that are not collapsed, rising."""
    first: np.ndarray
    """(k + 1,) samples of these."""
    fraction: np.ndarray
    """(n,) of their parameter ranges."""
    first_of_all: np.ndarray
    """(e + 1,) samples of all edges."""

    @classmethod
    def of(cls, arrays: ModelArrays, fractions: Sequence[np.ndarray]) -> Self:
        """fractions: of each edge that is not collapsed."""
        edges, count = np.flatnonzero(~arrays.collapsed), np.zeros(len(arrays.length), np.int64)
        count[edges] = [len(own) for own in fractions]
        fraction = np.concatenate([np.empty(0), *fractions])
        return cls(edges, offsets(count[edges]), fraction, offsets(count))


_KNOWN: WeakKeyDictionary[CadModel, dict[bool, _Places]] = WeakKeyDictionary()  # few or not


def _places(rules: EdgeRules, few: bool) -> _Places:
    """The same for all sizes without laws."""
    wanted, model, arrays = rules.wanted, rules.model, rules.arrays
    known = _KNOWN.setdefault(model, {})
    if few not in known:
        known[few] = _Places.of(arrays, _grids(model, arrays, few))
    if not any(
        own.has_law for own in (wanted.base, *wanted.faces.values(), *wanted.edges.values())
    ):
        return known[few]
    grids = zip(known[few].edges.tolist(), _grids(model, arrays, few))
    finer = [_with_hidden(model.edges[k], grid, rules.sizings_at(k)) for k, grid in grids]
    return _Places.of(arrays, finer)


def _grids(model: CadModel, arrays: ModelArrays, few: bool) -> list[np.ndarray]:
    """Of each edge that is not collapsed, by how it bends."""
    edges = np.flatnonzero(~arrays.collapsed).tolist()
    if few:
        kinds = [getattr(model.edges[edge].curve, "kind", "") for edge in edges]
        return [_OF_KIND.get(kind, _CURVED) for kind in kinds]
    return [_STRAIGHT if even else _CURVED for even in arrays.straight[edges].tolist()]


def _find_narrow(samples: EdgeSamples, rules: EdgeRules) -> None:
    """Fill in what is narrow; edges of narrow faces do not hear the curvature across these."""
    model, sizing, arrays = rules.model, rules.wanted, rules.arrays
    for own, numbers in sizing.sets(len(model.faces)):
        if not own.has_law:
            samples.narrow_width[numbers] = narrow_width(own, model.diagonal, np.empty((0, 3)))
            continue
        for number in numbers.tolist():
            points = samples.points[samples.along(number)]
            samples.narrow_width[number] = narrow_width(own, model.diagonal, points)
    samples.narrow.update(narrow_faces(model, samples))
    beside = {c.edge for number in samples.narrow for c in model.faces[number].coedges}
    for edge in sorted(beside):
        at, faces = samples.of(edge), rules.faces_of(edge)
        if at.start == at.stop:
            continue
        widths = [samples.narrow[face].width for face in faces if face in samples.narrow]
        width = max(samples.narrow_width[face] for face in faces)
        samples.tiny[edge] = model.edges[edge].length <= ROUND * width
        samples.hidden[edge] = len(widths) == len(faces)
        if samples.is_cut_by_shape(model, edge):
            size = np.full(at.stop - at.start, sizing.base.max_size or model.diagonal)
        else:
            limits = np.array([0, at.stop - at.start])
            courses = Courses.of(arrays, np.array([edge]), limits, samples.t[at])
            size = rules.target_size(courses, samples.narrow)
        samples.target_size[at] = np.minimum(size, MOST_LONGER * min(widths))


def _with_hidden(edge: CadEdge, t: np.ndarray, sizings: list[Sizing]) -> np.ndarray:
    """More fractions where laws may ask for much smaller sizes between two samples.

    A law of slope s that gives a and b at the ends of a piece of length l gives at least
    (a + b - s l) / 2 in between.
    """
    for sizing in {id(own): own for own in sizings if own.has_law}.values():
        slope = sizing.law_slope
        coarsest = min(sizing.max_size or np.inf, edge.length)
        if isinstance(sizing.size, float):
            coarsest = min(coarsest, sizing.size)
        finest = sizing.min_size or 0.0
        for _ in range(MOST_HALVINGS):
            (points,) = edge.evaluate(t, 0)
            size = np.minimum(sizing.law_sizes(points), coarsest)
            length = np.linalg.norm(np.diff(points, axis=0), axis=1)
            least = np.maximum(0.5 * (size[1:] + size[:-1] - slope * length), finest)
            smaller = np.minimum(size[1:], size[:-1])
            hiding = (least < HIDDEN * smaller) & (length > 0.5 * np.maximum(least, 0.1 * smaller))
            if not hiding.any() or len(t) > MOST_SAMPLES:
                break
            middle = 0.5 * (t[1:] + t[:-1])[hiding]
            t = np.sort(np.concatenate([t, middle]))
    return t


def _apply_vertices(samples: EdgeSamples, rules: EdgeRules) -> None:
    """Lower the sizes, in place, at the ends of edges to what their vertices ask for."""
    allowed = {number: rules.at_vertex(number) for number in rules.wanted.vertices}
    for number, edge in enumerate(rules.model.edges) if allowed else ():
        start, end = samples.first[number], samples.first[number + 1]
        if start < end:
            for vertex, place in ((edge.start, start), (edge.end, end - 1)):
                size = allowed.get(vertex, np.inf)
                samples.target_size[place] = min(samples.target_size[place], size)


def _apply_gaps(model: CadModel, samples: EdgeSamples, sizing: ModelSizing) -> None:
    """Lower the sizes, in place, for the distance of edges of the same face that do not meet.

    To that distance, or as small as ``gap`` says. Where triangles may be longer than wide and no
    number of them is asked for, to so many times the distance.
    """
    if not len(samples.points):
        return
    ends = model_arrays(model).mesh_ends
    by_sizes: dict[tuple[float | None, float, float], list[np.ndarray]] = {}
    for own, numbers in sizing.sets(len(model.faces)):
        if samples.narrow:  # across them is nothing to be meshed, nor beside the end of one side
            numbers = numbers[samples.is_wide[numbers]]
        width = samples.narrow_width[numbers]
        for narrow in sorted(set(width.tolist())):
            same = numbers[width == narrow]
            by_sizes.setdefault((own.gap, own.min_size or 0.0, narrow), []).append(same)
    slope = sizing.base.gradient
    ratio = sizing.base.anisotropy if sizing.is_anisotropic else 1.0
    narrowest = NARROWEST * model.diagonal
    asked = samples.target_size
    for (count, least, narrow), faces in by_sizes.items():
        first, edges = samples.edges_of_wide_faces
        if len(by_sizes) > 1:
            first, edges = samples.edges_of_faces(np.concatenate(faces))
        if not first[-1]:
            continue
        fraction = 1.0 if count is None else size_across(1.0, count, slope)
        found = gap_sizes(
            samples.points, asked if fraction == 1.0 else asked / fraction, samples.first, ends,
            edges, first, asked,
            along=ratio if count is None else fraction, least=least,
            ignored=max(SLIVER * model.diagonal, narrow), ignored_of_size=PROXIMITY_FLOOR,
            longer=LONGER, narrowest=narrowest, least_narrow=LEAST_NARROW * narrowest,
        )  # fmt: skip
        np.minimum(samples.gap_size, found, out=samples.gap_size)
    np.minimum(samples.target_size, samples.gap_size, out=samples.target_size)
