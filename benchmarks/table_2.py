"""The figures of Table 2 of Wang, Ming and Lo (2007), for the paper's five examples.

Size deviation (1): max(rho / r, r / rho) - 1, with rho the radius wanted at a circle's centre
and r the one it got. Two readings are printed: r as the circle was placed (the paper's words;
``Packing.radius`` of the circles inside the domain), and, from the finished raw mesh, r as half
the mean length of the edges at a vertex, which also counts every gap and overlap. Ratio (2) of
the radii at the two ends of an edge, 1 or more. Shape (3): alpha, in space.
"""

from collections.abc import Callable

import numpy as np
import shapely
from measures import field_of
from scipy.spatial import cKDTree
from target_count import node_count, sizing_for
from wanted import Wanted

import surfmesh as sm
from surfmesh.geometry.planar.domain_faces import inside_faces
from surfmesh.geometry.planar.planar_domain import PlanarDomain
from surfmesh.geometry.surface import Surface
from surfmesh.meshing.boundary.planar_segments import short_segments
from surfmesh.meshing.patch.packing import packed_over
from surfmesh.quality.measures.lengths import edge_figures
from surfmesh.quality.measures.shape import alpha
from surfmesh.sizing.field.size_field import SizeField, size_field
from surfmesh.sizing.options.distance_size import DistanceSize

RANDOM = "random size"
PLANAR = ("letter_a", "floor_plate")
SURFACES = ("two_peaks", "wavy")
SEEDS = 20  # packings of random size over which the figures are averaged
COUNT_TRIALS = 4
SHARP = 30.0  # degrees: below, the corner decides the shape of its triangles

PAPER = {
    RANDOM: {
        "nodes": 1000, "elements": 1898, "avg1": 0.151276, "max2": 327.3385, "avg2": 4.222539,
        "min3": 0.107286, "avg3": 0.823691, "seconds": 0.152,
    },
    "letter_a": {
        "nodes": 2552, "elements": 5058, "avg1": 0.062647, "max2": 3.918444, "avg2": 1.757723,
        "min3": 0.401702, "avg3": 0.878948, "seconds": 0.379,
    },
    "floor_plate": {
        "nodes": 8864, "elements": 17697, "avg1": 0.056686, "max2": 2.961564, "avg2": 1.395665,
        "min3": 0.486297, "avg3": 0.921719, "seconds": 1.327,
    },
    "two_peaks": {
        "nodes": 8138, "elements": 16200, "avg1": 0.031940, "max2": 4.055701, "avg2": 1.145573,
        "min3": 0.501469, "avg3": 0.946467, "seconds": 1.216,
    },
    "wavy": {
        "nodes": 40000, "elements": 79391, "avg1": 0.024702, "max2": 4.112251, "avg2": 1.105738,
        "min3": 0.618883, "avg3": 0.951014, "seconds": 6.082,
    },
}  # fmt: skip

OPTIMISED_AVG3 = 0.97
OPTIMISED_MIN3 = {"letter_a": 0.45, "floor_plate": 0.45, "two_peaks": 0.6, "wavy": 0.6}


def wanted(name: str, optimised: bool) -> dict[str, Wanted]:
    """Raw: no average worse than the paper's. Optimised: the shapes."""
    paper = PAPER[name]
    rows = {
        "nodes": Wanted("nodes", digits=0),
        "elements": Wanted("elements", digits=0),
        "max1": Wanted("Max1, size deviation", digits=4),
        "avg1": Wanted("Avg1, size deviation", most=paper["avg1"], digits=4),
        "avg1_mesh": Wanted("Avg1, by the edges of the raw mesh", digits=4),
        "max2": Wanted("Max2, ratio of neighbouring radii", digits=4),
        "avg2": Wanted("Avg2, ratio of neighbouring radii", most=paper["avg2"], digits=4),
        "min3": Wanted("Min3, alpha", digits=4),
        "avg3": Wanted("Avg3, alpha", least=paper["avg3"], digits=4),
        "seconds": Wanted("seconds", digits=3),
    }
    if optimised:
        rows |= {
            "avg2": Wanted("Avg2, ratio of neighbouring radii", digits=4),
            "min3": Wanted("Min3, off sharp corners", least=OPTIMISED_MIN3[name], digits=4),
            "avg3": Wanted("Avg3, alpha", least=OPTIMISED_AVG3, digits=4),
        }
        del rows["max1"], rows["avg1"], rows["avg1_mesh"]  # circles are those of the raw mesh
    return rows


def random_figures(seeds: int = SEEDS) -> dict:
    """Means of the figures over ``seeds`` packings, radii from 1 to 1000; the spread of Avg2.

    A few circles of the smallest radii decide Avg2: it differs much from seed to seed.
    """
    keys = ("nodes", "elements", "max1", "avg1", "max2", "avg2", "min3", "avg3", "seconds")
    count = PAPER[RANDOM]["nodes"]
    found = [
        sm.pack(sm.UniformRadius(1.0, 1000.0, seed=seed), count=count).statistics
        for seed in range(seeds)
    ]
    means = {key: float(np.mean([one.to_dict()[key] for one in found])) for key in keys}
    ratios = [one.neighbour_ratio_mean for one in found]
    return means | {"avg2_least": float(np.min(ratios)), "avg2_most": float(np.max(ratios))}


def mesh_figures(surface: Surface, sizing: sm.Sizing, optimise: bool) -> dict:
    """Of one mesh; those of its circles (1) only where they were left as they were packed."""
    mesh = sm.mesh(surface, sizing, optimise=optimise)
    a, b = mesh.sizes[mesh.edges].T
    ratio = np.maximum(a / b, b / a)
    shape = alpha(mesh)
    at_sharp_corner = _sharp_corners(mesh, surface)[mesh.triangles].any(axis=1)
    found = {
        "nodes": len(mesh.points),
        "elements": len(mesh.triangles),
        "max2": float(ratio.max()),
        "avg2": float(ratio.mean()),
        "min3": float((shape[~at_sharp_corner] if optimise else shape).min()),
        "avg3": float(shape.mean()),
        "seconds": sum(mesh.seconds.values()),
    }
    if not optimise:
        placed = _deviation(_placed_radii(surface, sizing))
        unit = np.repeat(edge_figures(mesh).metric_lengths, 2)
        around = np.bincount(mesh.edges.ravel(), unit) / np.bincount(mesh.edges.ravel())
        found |= {
            "max1": float(placed.max()),
            "avg1": float(placed.mean()),
            "avg1_mesh": float(_deviation(around).mean()),
        }
    return found


def sizing_at_papers_count(name: str, growth: float) -> sm.Sizing:
    """The sizing whose raw mesh has about as many nodes as the paper's."""
    surface, nodes = sm.load(name), PAPER[name]["nodes"]
    if not isinstance(surface, PlanarDomain):
        count = node_count(surface, optimise=False)
        return sm.Sizing(**sizing_for(surface, nodes, growth, count=count, tolerance=0.005))
    law = surface.sizing_defaults["distance"]
    scale = 1.0
    for _ in range(COUNT_TRIALS):
        sizes = DistanceSize(
            surface, near=scale * law["near"], far=scale * law["far"], reach=law["reach"]
        )
        sizing = sm.Sizing(size=sizes, growth=surface.sizing_defaults["growth"])
        found = len(sm.mesh(surface, sizing, optimise=False).points)
        if abs(found / nodes - 1.0) < 0.01:
            break
        scale *= (found / nodes) ** 0.5
    return sizing


def _deviation(ratio: np.ndarray) -> np.ndarray:
    return np.maximum(ratio, 1.0 / ratio) - 1.0


def _placed_radii(surface: Surface, sizing: sm.Sizing) -> np.ndarray:
    """Got over wanted radius of the circles whose centres lie in the domain."""
    field, is_inside = _field(surface, sizing)
    packing = packed_over(field, field.chart)
    return packing.radius[is_inside(packing.t.xy)]


def _field(surface: Surface, sizing: sm.Sizing) -> tuple[SizeField, Callable]:
    """The size field, and which points (n, 2) of its scaled plane lie in the domain."""
    if isinstance(surface, PlanarDomain):
        limits = short_segments(surface.graph, sizing.gradient)
        field = size_field(surface, sizing, None, limits)
        inside = shapely.union_all(inside_faces(surface.graph))
        shapely.prepare(inside)
        return field, lambda xy: shapely.contains_xy(inside, field.chart.to_uv(xy))
    field = field_of(surface, sizing)
    extent = np.array(field.chart.extent)
    return field, lambda xy: ((xy >= 0.0) & (xy <= extent)).all(axis=1)


def _sharp_corners(mesh: sm.SurfaceMesh, surface: Surface) -> np.ndarray:
    """(n,) bool: vertices where two segments of a planar domain meet at under 30 degrees."""
    sharp = np.zeros(len(mesh.points), bool)
    if not isinstance(surface, PlanarDomain):
        return sharp
    graph = surface.graph
    ends = np.concatenate([graph.segments, graph.segments[:, ::-1]])
    step = graph.points[ends[:, 1]] - graph.points[ends[:, 0]]
    direction = np.degrees(np.arctan2(step[:, 1], step[:, 0]))
    order = np.lexsort((direction, ends[:, 0]))
    corners = []
    for at in np.split(order, np.flatnonzero(np.diff(ends[order, 0])) + 1):
        turns = np.diff(direction[at], append=direction[at[0]] + 360.0)
        if turns.min() < SHARP:
            corners.append(graph.points[ends[at[0], 0]])
    if corners:
        sharp[cKDTree(mesh.points[:, :2]).query(np.array(corners))[1]] = True
    return sharp
