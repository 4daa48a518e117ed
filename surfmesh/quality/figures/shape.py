"""The shape of the triangles, and how they are turned against the surface."""

from dataclasses import dataclass

import numpy as np

from surfmesh._core.quality import quantile
from surfmesh.quality.figures.part import Part
from surfmesh.quality.measures.folds import FoldedTriangle, most_folded
from surfmesh.quality.measures.measurements import LISTED, Measurements
from surfmesh.quality.measures.narrow import DEGENERATE, narrow_triangles
from surfmesh.quality.measures.spread import Spread


@dataclass(frozen=True, kw_only=True)
class ShapeFigures(Part):
    """In 3D; angles in degrees."""

    alpha_mean: float  # 4 sqrt(3) area / sum of squared edges, in 3D; 1 is equilateral
    alpha_p01: float  # 1 % of the triangles are worse
    alpha_min: float
    narrow_triangles: int  # on faces of a CAD model that are narrower than the chord: good shape
    # is not owed there; alpha, angles and edges are of all triangles
    alpha_mean_elsewhere: float | None  # of the others; None: there are none
    alpha_min_elsewhere: float | None
    alpha_metric_mean: float | None  # alpha as seen in the metric; None: isotropic, as in 3D
    alpha_metric_min: float | None
    radius_ratio_mean: float  # 2 r_in / r_circum; 1 is equilateral
    radius_ratio_min: float
    min_angle_deg: float
    max_angle_deg: float
    degenerate: int  # triangles with alpha below 1e-6
    jacobian_min: float | None  # of quadratic triangles, over that of the straight ones, as seen
    # along their normals: no less anywhere, by Bernstein bounds; None: they are straight

    @classmethod
    def of(cls, measured: Measurements) -> "ShapeFigures":
        """nan where there is no triangle."""
        shape, metric = measured.shapes, measured.metric_alpha
        alpha, radius_ratio = measured.alpha_spread, Spread.of(shape.radius_ratio)
        narrow = narrow_triangles(measured.mesh, shape.alpha, alpha)
        flat = 0 if alpha.least > DEGENERATE else np.count_nonzero(~(shape.alpha > DEGENERATE))
        metric_alpha = None if metric is None else Spread.of(metric)
        return cls(
            alpha_mean=alpha.mean,
            alpha_p01=quantile(shape.alpha, 0.01) if len(shape.alpha) else float("nan"),
            alpha_min=alpha.least,
            narrow_triangles=narrow.number,
            alpha_mean_elsewhere=narrow.alpha_mean_elsewhere,
            alpha_min_elsewhere=narrow.alpha_min_elsewhere,
            alpha_metric_mean=None if metric_alpha is None else metric_alpha.mean,
            alpha_metric_min=None if metric_alpha is None else metric_alpha.least,
            radius_ratio_mean=radius_ratio.mean,
            radius_ratio_min=radius_ratio.least,
            min_angle_deg=Spread.of(shape.min_angle).least,
            max_angle_deg=Spread.of(shape.max_angle).largest,
            degenerate=int(flat),
            jacobian_min=(
                None
                if measured.curved_shapes is None
                else Spread.of(measured.curved_shapes.jacobian).least
            ),
        )


@dataclass(frozen=True, kw_only=True)
class FoldFigures(Part):
    """Triangles turned far from the surface's normals. None: no surface is known."""

    folded: int | None  # triangles turned more than 60 degrees from the surface, inverted too
    inverted: int | None  # triangles turned more than 90 degrees from the surface
    folded_by_surface: int | None  # where the surface bends sharply or turns over: not counted
    # as folded or inverted
    folded_at: tuple[FoldedTriangle, ...]  # the twenty that are turned most

    @classmethod
    def of(cls, measured: Measurements) -> "FoldFigures":
        """Those that the surface folds itself are counted apart."""
        folds = measured.folds
        if folds is None:
            return cls(folded=None, inverted=None, folded_by_surface=None, folded_at=())
        return cls(
            folded=int(np.count_nonzero(folds.by_mesh)),
            inverted=int(np.count_nonzero(folds.inverted)),
            folded_by_surface=int(np.count_nonzero(folds.by_surface)),
            folded_at=most_folded(measured.mesh, folds, LISTED),
        )
