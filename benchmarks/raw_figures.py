"""Raw meshes (optimise=False) beside Table 2 of Wang, Ming and Lo (2007).

Size deviation (1): max(rho / r, r / rho) - 1, with rho the radius wanted at a circle's centre
and r the one it got. Two readings are printed: r as the circle was placed (the paper's words;
``Packing.radius`` of the circles inside the domain), and, from the finished raw mesh, r as half
the mean length of the edges at a vertex, which also counts every gap and overlap.
Ratio (2) of the radii wanted at the two ends of an edge, 1 or more. Shape (3): alpha, in space.
"""

import numpy as np
from measures import field_of
from target_count import node_count, sizing_for
from wanted import Wanted

import surfmesh as sm
from surfmesh.meshing.packing import packed
from surfmesh.quality.lengths import edge_lengths, metric_lengths
from surfmesh.quality.shape import alpha

NODES = {"two_peaks": 8138, "wavy": 40000}
PAPER = {
    "two_peaks": {
        "nodes": 8138, "elements": 16200, "avg1": 0.031940, "max2": 4.055701,
        "avg2": 1.145573, "min3": 0.501469, "avg3": 0.946467, "seconds": 1.216,
    },
    "wavy": {
        "nodes": 40000, "elements": 79391, "avg1": 0.024702, "max2": 4.112251,
        "avg2": 1.105738, "min3": 0.618883, "avg3": 0.951014, "seconds": 6.082,
    },
}  # fmt: skip


def wanted(name: str) -> dict[str, Wanted]:
    paper = PAPER[name]
    return {
        "nodes": Wanted("nodes", digits=0),
        "elements": Wanted("elements", digits=0),
        "avg1": Wanted("Avg1, size deviation of the circles", most=paper["avg1"], digits=4),
        "avg1_mesh": Wanted("Avg1, by the edges of the raw mesh", digits=4),
        "max2": Wanted("Max2, ratio of neighbouring radii", digits=4),
        "avg2": Wanted("Avg2, ratio of neighbouring radii", most=paper["avg2"], digits=4),
        "min3": Wanted("Min3, alpha", least=paper["min3"], digits=4),
        "avg3": Wanted("Avg3, alpha", least=paper["avg3"], digits=4),
        "seconds": Wanted("seconds", digits=3),
    }


def raw_figures(name: str, growth: float) -> dict:
    surface = sm.load(name)
    count = node_count(surface, optimise=False)
    sizing = sizing_for(surface, NODES[name], growth, count=count, tolerance=0.005)
    mesh = sm.mesh(surface, sm.Sizing(**sizing), optimise=False)
    unit = metric_lengths(mesh, edge_lengths(mesh))
    ends = mesh.edges.ravel()
    got = np.bincount(ends, np.repeat(unit, 2)) / np.bincount(ends)
    a, b = mesh.sizes[mesh.edges].T
    ratio = np.maximum(a / b, b / a)
    shape = alpha(mesh)
    return {
        "sizing": sizing,
        "nodes": len(mesh.points),
        "elements": len(mesh.triangles),
        "avg1": float(_deviation(_placed_radii(surface, sizing)).mean()),
        "avg1_mesh": float(_deviation(got).mean()),
        "max2": float(ratio.max()),
        "avg2": float(ratio.mean()),
        "min3": float(shape.min()),
        "avg3": float(shape.mean()),
        "seconds": sum(mesh.seconds.values()),
    }


def _deviation(ratio: np.ndarray) -> np.ndarray:
    return np.maximum(ratio, 1.0 / ratio) - 1.0


def _placed_radii(surface, sizing: dict) -> np.ndarray:
    """Got over wanted radius of the circles whose centres lie in the domain."""
    field = field_of(surface, sizing)
    width, height = field.scaling.extent
    packing = packed(
        field.background,
        (0.0, 0.0, width, height),
        (0.5 * width, 0.5 * height),
        field.expected_vertices(),
    )
    count = int(packing.t.count[0])
    x, y = packing.t.xy[:count].T
    return packing.radius[:count][(x >= 0) & (x <= width) & (y >= 0) & (y <= height)]
