"""Edge lengths, against the target sizes and against each other."""

from dataclasses import dataclass

import numpy as np

from surfmesh.quality.figures.part import Part
from surfmesh.quality.measures.lengths import QUASI_UNIT
from surfmesh.quality.measures.measurements import Measurements
from surfmesh.quality.measures.places import Point
from surfmesh.quality.measures.spread import Spread


@dataclass(frozen=True, kw_only=True)
class SizeFigures(Part):
    """In model units. None: no target sizes are known."""

    edge_min: float
    edge_mean: float
    edge_max: float
    quasi_unit_share: float | None  # edges within [1/sqrt 2, sqrt 2] of the target size
    length_mean: float | None  # of length / target size, over all edges
    length_std: float | None
    length_min: float | None
    length_max: float | None
    growth_max: float  # longest over shortest edge at a vertex; in target sizes where those
    # depend on the direction
    growth_p99: float
    growth: float | None  # asked for: the largest ratio of neighbouring sizes
    above_growth_share: float | None  # edges whose ends have target sizes that differ by more than
    # 1.1 times what growth allows
    size_growth_max: float | None  # largest such difference over what growth allows: 1 is allowed
    size_growth_point: Point | None  # middle of that edge

    @classmethod
    def of(cls, measured: Measurements) -> "SizeFigures":
        """Lengths over target sizes are those in the metric."""
        edges, metric = measured.edges, measured.metric_lengths
        sizing, steep = measured.mesh.sizing, measured.size_growth
        conform = None
        if metric is not None and len(metric):
            low, high = QUASI_UNIT
            conform = float(np.count_nonzero((metric >= low) & (metric <= high)) / len(metric))
        edge, (growth_max, growth_p99) = Spread(*edges.length), edges.ratios
        length = None if metric is None else Spread(*edges.metric_length)
        return cls(
            edge_min=edge.least,
            edge_mean=edge.mean,
            edge_max=edge.largest,
            quasi_unit_share=conform,
            length_mean=None if length is None else length.mean,
            length_std=None if length is None else length.deviation,
            length_min=None if length is None else length.least,
            length_max=None if length is None else length.largest,
            growth_max=growth_max,
            growth_p99=growth_p99,
            growth=None if sizing is None else sizing.growth,
            above_growth_share=None if steep is None else steep.fraction,
            size_growth_max=None if steep is None else steep.largest,
            size_growth_point=None if steep is None else steep.point,
        )
