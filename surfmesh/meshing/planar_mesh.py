"""A planar domain, all stages: the paper's section 3 with holes, constraint lines and regions.

size field <-> segments cut   ->  packing -> boundary -> regions -> optimisation -> the mesh
       short lines and gaps
"""

from collections.abc import Mapping

import numpy as np

from surfmesh._core.insertion import label_patches
from surfmesh._core.triangulation import Triangulation
from surfmesh.geometry.boxes import diagonal
from surfmesh.geometry.differential.chart import Chart
from surfmesh.geometry.files.known_facts import known_facts
from surfmesh.geometry.planar.planar_domain import PlanarDomain
from surfmesh.meshing.boundary.planar_segments import (
    PlanarSegments,
    cut_segments,
    metric_length,
    narrow_gaps,
    short_segments,
)
from surfmesh.meshing.estimate.estimation import (
    Estimate,
    combined,
    fewest_triangles,
    field_triangles,
    require_field_within,
    require_within,
)
from surfmesh.meshing.estimate.trial_mesh import WHOLE, counts_within_budget
from surfmesh.meshing.patch.patch_mesh import PatchMesh, mesh_patch
from surfmesh.meshing.patch.refinement_loop import refined_in_rounds
from surfmesh.meshing.progress import Progress, Stopwatch
from surfmesh.result.surface_mesh import SurfaceMesh
from surfmesh.sizing.field.size_field import COUNTABLE, SizeField, size_field
from surfmesh.sizing.options.sizing import Sizing
from surfmesh.sizing.rules.across_gaps import size_across
from surfmesh.sizing.rules.size_limits import SizeLimits
from surfmesh.sizing.rules.size_rules import SizeRules

GAP_ROUNDS = 3
"""How often the size field is made anew because gaps were found, at most."""


THINNING = 0.125
"""Of the smallest size that is asked for along the lines: how far ``simplify`` may move them. A
segment of that size passes an arc of the strongest bend that is worth following as closely."""

MANY = 4.0
"""More than so many times the limit is refused before the lines are cut."""

FAR_BELOW = 0.5
"""Segments shorter than this fraction of ``min_size`` are worth a word."""


def mesh_planar(
    domain: PlanarDomain, sizing: Sizing, optimise: bool = True, progress: Progress | None = None,
    simplify: bool = False,
) -> SurfaceMesh:  # fmt: skip
    """Mesh the inside of a planar domain; every segment is followed by edges of the mesh.

    simplify=True thins lines that are finer than the sizes first, within ``chord`` or else an
    eighth of the smallest size asked for along them. Raises ``SizingError`` or ``DomainError``
    with the reason.
    """
    watch = Stopwatch(progress)
    with watch.stage("sizing"):
        if simplify:
            domain = domain.simplified(_thinning_distance(domain, sizing))
        field, found = _field_and_segments(domain, sizing)
        if found is None:
            asked = Estimate.of([_asked(domain, field)])
            require_within(sizing.limit, asked, [domain.name])
        assert found is not None  # noqa: S101  many times the limit was refused
        cut = found
        loops = [*domain.outer, *domain.holes]
        require_field_within(sizing.limit, field, loops, domain.name)
    patch = mesh_patch(domain, field.chart, field, cut, optimise=optimise, watch=watch)
    return _with_regions(domain, cut, patch, field.sizing, watch)


def _thinning_distance(domain: PlanarDomain, sizing: Sizing) -> float:
    if sizing.chord is not None:
        return sizing.chord
    bounds = SizeRules.of(sizing, diagonal(domain.graph.points))
    size = bounds.clamp[1]
    if sizing.has_law:
        points = np.column_stack([domain.graph.points, np.zeros(len(domain.graph.points))])
        size = min(size, float(sizing.law_sizes(points).min()))
    return THINNING * max(size, sizing.min_size or 0.0) if np.isfinite(size) else bounds.clamp[0]


def _too_fine(domain: PlanarDomain, sizing: Sizing) -> list[str]:
    """A sentence where lines are cut more finely than the smallest size that is asked for."""
    if not sizing.min_size:
        return []
    ends = domain.graph.points[domain.graph.segments]
    length = np.linalg.norm(ends[:, 1] - ends[:, 0], axis=1)
    short = np.flatnonzero(length < FAR_BELOW * sizing.min_size)
    if not len(short):
        return []
    shortest = domain.graph.origin(int(length.argmin()))
    return [
        f"{len(short):,} of {len(length):,} segments are shorter than half of min_size "
        f"{sizing.min_size:g}, down to {length.min():.3g} ({shortest}): they are "
        "followed all the same, and triangles there are thin; simplify=True thins them"
    ]


def estimate_planar(domain: PlanarDomain, sizing: Sizing) -> Estimate:
    """Triangles and memory of ``mesh_planar``. Raises as it does."""
    field, cut = _field_and_segments(domain, sizing)
    if cut is None:
        return Estimate.of([_asked(domain, field)])
    loops = [*domain.outer, *domain.holes]
    asked = _combined(field, loops, len(cut.uv))
    if asked <= WHOLE:
        made = counts_within_budget(lambda budget: mesh_planar(domain, sizing, progress=budget))
        if made is not None:
            return Estimate.of([made.sum()])
    return Estimate.of([asked])


def _asked(domain: PlanarDomain, field: SizeField) -> float:
    """Triangles, before a segment is cut."""
    loops = [*domain.outer, *domain.holes]
    nodes = min(metric_length(domain.graph, field), COUNTABLE)
    return _combined(field, loops, int(nodes))


def _combined(field: SizeField, loops: list[np.ndarray], nodes: int) -> float:
    fewest = fewest_triangles(nodes, len(loops))
    return float(combined(np.array(field_triangles(field, loops)), np.array(fewest)))


def _is_suspicious(domain: PlanarDomain, field: SizeField) -> bool:
    """A look at the whole rectangle and at the lines, which costs little."""
    limit = MANY * field.sizing.limit
    return 2 * field.expected_vertices() > limit or metric_length(domain.graph, field) > limit


def _field_and_segments(
    domain: PlanarDomain, sizing: Sizing
) -> tuple[SizeField, PlanarSegments | None]:
    """None: far more triangles than the limit are asked for; no segment is cut."""
    fraction = 1.0 if sizing.gap is None else size_across(1.0, sizing.gap, sizing.gradient)

    chart = Chart.of(domain)

    def one_round(
        limits: Mapping[int, SizeLimits],
    ) -> tuple[tuple[SizeField, PlanarSegments | None], dict[int, SizeLimits]]:
        field = size_field(domain, sizing, None, limits.get(0), chart=chart)
        if _is_suspicious(domain, field) and _asked(domain, field) > MANY * sizing.limit:
            return (field, None), {}
        cut = cut_segments(domain.graph, field)
        gaps = narrow_gaps(domain, cut, field, sizing.gradient, fraction)
        return (field, cut), {} if gaps is None else {0: gaps}

    short = short_segments(domain.graph, sizing.gradient)
    known = {} if short is None else {0: short}
    return refined_in_rounds(one_round, SizeLimits.joined_with, GAP_ROUNDS, known)


def _with_regions(
    domain: PlanarDomain, cut: PlanarSegments, patch: PatchMesh, sizing: Sizing, watch: Stopwatch
) -> SurfaceMesh:
    t = patch.domain.t
    label, count = label_patches(t.adj, t.fixed, t.region)
    regions = _region_numbers(t, cut, patch.domain.node, label, count)
    return SurfaceMesh(
        points=patch.space.points,
        triangles=patch.space.triangles,
        uv_points=patch.uv[patch.space.vertex],
        face_ids=regions[label[label >= 0]],
        surfaces=domain.region_surfaces(count),
        sizes=patch.sizes,
        sizing=sizing,
        seconds=watch.seconds,
        warnings=(*domain.warnings, *_too_fine(domain, sizing)),
        facts=known_facts(domain),
    )


def _region_numbers(
    t: Triangulation, cut: PlanarSegments, node: np.ndarray, label: np.ndarray, count: int
) -> np.ndarray:
    """The number of each region (count,): by the first segment along it, its left side first.

    Independent of the triangles, so that regions keep their numbers when sizes change.
    """
    half_edges = np.flatnonzero(t.fixed)
    half_edges = half_edges[label[half_edges // 3] >= 0]
    width = np.int64(len(t.xy))
    following = half_edges + np.where(half_edges % 3 == 2, -2, 1)
    keys = t.tri[half_edges] * width + t.tri[following]
    order = np.argsort(keys)
    first = np.full(count, np.iinfo(np.int64).max)
    a, b = node[cut.subsegments].astype(np.int64).T
    for side, wanted in enumerate((a * width + b, b * width + a)):
        place = np.minimum(np.searchsorted(keys[order], wanted), len(keys) - 1)
        found = (keys[order][place] == wanted) & (a >= 0) & (b >= 0)
        of = label[half_edges[order][place[found]] // 3]
        np.minimum.at(first, of, 2 * cut.segment[found].astype(np.int64) + side)
    numbers = np.empty(count, np.int32)
    numbers[np.argsort(first, kind="stable")] = np.arange(count)
    return numbers
