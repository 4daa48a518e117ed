"""The background of a size field: the sizes of one surface, graded, on a balanced quadtree.

The core builds it level by level (src/fields/field_builder.hpp): it asks a law for the sizes at
blocks of nodes, and where features may hide between them. Here is what is asked: of which cells
the search starts, what counts as too much, and what errors say.
"""

import numpy as np

import surfmesh._core.fields as core
from surfmesh._core import elementary_functions
from surfmesh._core import sizing as core_sizing
from surfmesh._core.fields import Background
from surfmesh.errors import SizingError
from surfmesh.geometry.cad_surfaces.face_surface import FaceSurface
from surfmesh.geometry.differential.sides import SideTopology
from surfmesh.sizing.field.size_law import FieldNodes, SizeLaw, TensorLaw
from surfmesh.sizing.field.small_sizes import small_sizes
from surfmesh.sizing.rules.direction_rates import has_even_curvature

ROOT_CELLS = 2304
"""About how many cells the search starts with: a smooth surface needs no more."""

POLE_DISTANCE = 0.9
"""In edges: the first ring of triangles around a pole lies about there."""

FAR_BEYOND = 2.0
"""Times the limit of triangles: so many are not asked for by mistake of a coarse sampling."""

FREE_CELLS = 200_000
"""Of a surface of formulas: beyond so many, cells are held to the triangles that they ask for."""

_OPEN_SIDES = [-1] * 4, [False] * 4


class FieldBuilder:
    """Makes one background."""

    def __init__(
        self, law: SizeLaw | TensorLaw, sides: SideTopology | None = None, coarseness: float = 1.0
    ) -> None:  # fmt: skip
        """sides: which of the domain are joined. coarseness: see ``size_field``."""
        self.surface = surface = law.surface
        self.sides = sides
        self.chart = law.chart
        self.law = law
        width, height = self.chart.extent.tolist()
        roots = ROOT_CELLS
        if isinstance(surface, FaceSurface):
            roots = core.root_cells_of_face(surface.pieces)
        grid = nx, ny = core.root_grid((width, height), roots)
        self.core = core.FieldBuilder(
            grid=grid,
            extent=(width, height),
            root_step=(width / nx, height / ny),
            slope=law.sizing.gradient,
            largest=16.0 * max(width, height),  # for degenerate points
            sides=_OPEN_SIDES if sides is None else (list(sides.partner), list(sides.reversed)),
            sources=self._sources(grid),
            known_sizes=law.limits is not None and law.limits.uv is not None,
            counts_triangles=self._is_of_formulas,
            free_cells=FREE_CELLS,
            most_triangles=self._most_triangles,
            looks_for_hidden=(
                self._is_of_formulas and law.follows_curvature,  # splines bound nothing
                law.sizing.chord is not None,
            ),
            coarseness=coarseness,
        )

    def background(self) -> Background:
        """Raises ``SizingError`` when the sizes need an unreasonable number of cells."""
        asked, hidden = self._asked()
        self._require_done(self.core.refine(asked, hidden))
        if isinstance(asked, core_sizing.StretchedLaw) and not has_even_curvature(self.surface):
            chord = self.law.sizing.chord or 0.0
            self._require_done(core_sizing.limit_longer_sizes(self.core, asked, chord))
        self._blunt_poles()
        return self.core.background()

    @property
    def _nodes(self) -> FieldNodes:
        """Those of the core: what is written there holds."""
        arrays = FieldNodes(*self.core.nodes())
        return arrays._replace(jacobian=arrays.jacobian.reshape(-1, 3, 2))

    @property
    def _is_of_formulas(self) -> bool:
        return isinstance(self.law, SizeLaw) and not isinstance(self.surface, FaceSurface)

    @property
    def _most_triangles(self) -> float:
        """More would be a mistake. Those of a CAD model are counted elsewhere."""
        if not isinstance(self.law, SizeLaw):
            return np.inf
        if not (self._is_of_formulas or self.law.sizing.has_law):
            return np.inf
        return FAR_BEYOND * self.law.sizing.limit

    def _sources(self, grid: tuple[int, int]) -> np.ndarray:
        """Places (k, 3) of small sizes on the core's grid, and how deep cells there shall be."""
        if not isinstance(self.law, SizeLaw):
            return np.empty((0, 3), np.int64)
        uv, sizes = small_sizes(
            self.surface, self.law.sizing, self.law.limits, self.law.loop_limits
        )
        width, height = self.chart.extent.tolist()
        return core.small_sources(self.chart.to_plane(uv), sizes, grid, (width, height))

    def _require_done(self, outcome: tuple[str, tuple[float, float], float]) -> None:
        """Raise SizingError for what the core could not do."""
        status, place, number = outcome
        if status == "done":
            return
        u, v = self.chart.to_uv(np.array([place]))[0]
        near = f"near (u, v) = ({u:.6g}, {v:.6g})"
        if status == "too_many_triangles":
            raise SizingError(
                f"about {number:.2g} triangles are asked for on {self.surface.name!r}, most "
                f"{near}, far more than the limit of {self.law.sizing.limit:,}: ask for a larger "
                "chord, size or min_size, or a smaller part of the domain"
            )
        if status == "too_many_cells":
            raise SizingError(
                f"the sizes asked for on {self.surface.name!r} need more than {int(number):,} "
                f"cells to describe, most {near}, where the surface may be singular: raise "
                "min_size or growth, or leave that place out of the domain"
            )
        raise SizingError(
            f"the sizes on {self.surface.name!r} cannot be graded from one place to the next, "
            f"{near}, where the surface is as steep as a wall: raise min_size or growth, or leave "
            "that place out of the domain"
        )

    def _asked(self) -> tuple:
        """The law, and where features may hide, as the core asks for them."""
        law = self.law
        if not isinstance(law, SizeLaw):  # nothing hides in what is given: see looks_for_hidden
            return law, _nothing_hides
        in_core = law.in_core()
        hidden = core_sizing.BoundedFeatures(in_core, law.sizing.angle, law.sizing.chord)
        return in_core, hidden

    def _blunt_poles(self) -> None:
        """Cap the stretch near sides that are one point in space.

        There the wanted length along the side is infinite in (u, v): whoever comes nearer to
        the pole than ``POLE_DISTANCE`` edges is given the metric at that distance, so that the
        side is cut as the ring of triangles around the pole is.
        """
        if self.sides is None or not any(self.sides.collapsed):
            return
        xy, nodes = self.core.plane(), self._nodes
        width, height = self.chart.extent
        for side in np.flatnonzero(self.sides.collapsed):
            across = 1 if side in (0, 2) else 0
            far = (0.0, width, height, 0.0)[side]
            away = np.abs(xy[:, across] - far)
            # metric speed across the side, of the nodes themselves: finite at the pole
            speed = elementary_functions.hypot(*nodes.root[:, across : across + 2].T)
            depth = np.minimum(
                POLE_DISTANCE * nodes.size / np.maximum(speed, 1e-300),
                0.25 * self.chart.extent[across],
            )
            near = np.flatnonzero(away < depth)
            moved = xy[near]
            moved[:, across] = np.abs(far - depth[near])
            elsewhere = self.law(moved)
            nodes.root[near] = elsewhere.root
            if nodes.is_anisotropic:
                nodes.along[near] = elsewhere.along
                nodes.jacobian[near] = elsewhere.jacobian


def _nothing_hides(deep: bool, low: np.ndarray, *_: np.ndarray) -> np.ndarray:
    """In what is given over a plane."""
    return np.zeros(len(low), bool)
