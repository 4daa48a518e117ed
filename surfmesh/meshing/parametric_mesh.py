"""One parametric surface, all stages: the spine of surfmesh.

sides -> size field -> packing -> boundary -> optimisation -> space, joined sides identified
  ^                                                              |
  +---------- smaller sizes where the mesh is not right ---------+
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING

import numpy as np

from surfmesh.errors import MeshingError, SizingError, SurfaceError
from surfmesh.geometry.differential.chart import Chart
from surfmesh.geometry.differential.sides import SideTopology, find_sides
from surfmesh.geometry.files.known_facts import known_facts
from surfmesh.geometry.formulas.kinks import kink_lines
from surfmesh.geometry.formulas.parametric import ParametricSurface
from surfmesh.geometry.surface import Surface
from surfmesh.meshing.boundary.boundary_loops import BoundaryLoops, boundary_loops
from surfmesh.meshing.boundary.cusps import Cusp, closed_at, find_cusps, without_cusps
from surfmesh.meshing.boundary.kink_segments import sides_met, with_kinks
from surfmesh.meshing.estimate.estimation import (
    COARSENESS,
    COARSENESS_STRETCHED,
    Estimate,
    field_triangles,
    require_field_within,
)
from surfmesh.meshing.estimate.least_counts import least_of_surface
from surfmesh.meshing.estimate.trial_mesh import (
    FEW,
    LARGEST_TURN,
    WHOLE,
    counts_within_budget,
    is_one_round,
    largest_turn,
)
from surfmesh.meshing.estimate.trial_patches import (
    LARGEST_FRACTION,
    WIDE,
    plan_within,
    triangles_per_unit,
)
from surfmesh.meshing.finishing.balanced_rounds import (
    WIDER,
    balanced_in_rounds,
    widened,
    with_chord_of_surface,
)
from surfmesh.meshing.finishing.curved_requests import requests_for_curved
from surfmesh.meshing.finishing.enclosed_solids import solids_of_surface
from surfmesh.meshing.patch.patch_mesh import PatchMesh, mesh_patch
from surfmesh.meshing.patch.proved_patch import Patch, cut_until_proved
from surfmesh.meshing.patch.refinement_loop import (
    MAX_ROUNDS,
    MAX_ROUNDS_FOR_PROOF,
    StagnationCheck,
    refined_in_rounds,
)
from surfmesh.meshing.patch.size_requests import joined
from surfmesh.meshing.progress import Progress, Stopwatch
from surfmesh.result.surface_mesh import SurfaceMesh
from surfmesh.sizing.field.size_field import SizeField, size_field
from surfmesh.sizing.options.sizing import ON_SURFACE, Sizing
from surfmesh.sizing.rules.rim_rule import Rims
from surfmesh.sizing.rules.size_limits import SizeLimits

if TYPE_CHECKING:
    from surfmesh.meshing.explain.explanation import Explanation

MOST_CELLS, CELLS_OF_TRIANGLE = 250_000, 50
"""No further round once the size fields of all rounds had so many cells, or so many for each
triangle of the mesh if that is more: about a singular place each round needs more of them."""

FINER = 0.6
"""Factor on the sizes where sides cannot be joined."""

EVEN_ROUNDS = 2
"""In which triangles use the chord evenly, see ``Sizing.fewest``."""


def mesh_parametric(
    surface: Surface, sizing: Sizing, optimise: bool = True, progress: Progress | None = None
) -> SurfaceMesh:
    """Mesh one surface over its (u, v) rectangle or inside its trimming loops.

    Where triangles are folded, farther from the surface than ``chord`` or meet at more than
    ``angle`` after the optimiser has done what it can, or sides cannot be joined, the sizes are
    lowered and everything is done again. With ``optimise=False`` only joined sides are looked at.
    Vertices are moved off the surface last, where they are to be balanced.
    Raises ``SizingError``, ``SurfaceError`` or ``MeshingError`` with the place and the reason.
    """
    watch = Stopwatch(progress)
    if not sizing.is_balanced:
        return _on_surface(surface, sizing, optimise, watch, {})
    own = with_chord_of_surface(surface, sizing)
    chord = np.inf if own.chord is None else own.chord
    mesh = balanced_in_rounds(
        lambda wider, limits: _on_surface(surface, widened(own, wider), optimise, watch, limits),
        lambda _: np.array([chord]),
        lambda _: np.array([own.angle or np.inf]),
        solids_of_surface,
    )
    made = mesh.sizing
    assert made is not None  # noqa: S101  for mypy: as every mesh that is made here
    asked = made.replaced(chord=None if np.isinf(chord) else chord, volume=sizing.volume)
    return mesh.replaced(sizing=asked)


def _on_surface(
    surface: Surface, sizing: Sizing, optimise: bool, watch: Stopwatch,
    limits: Mapping[int, SizeLimits],
) -> SurfaceMesh:  # fmt: skip
    """The mesh with its vertices on the surface, its sizes within limits that are known before."""
    with watch.stage("sizing"):
        part, sides, cusps = _without_cusps(surface, sizing)
        rounds = _Rounds(part, sides, sizing, optimise, watch)
    mesh = rounds.mesh(limits)
    return closed_at(mesh, surface, cusps) if cusps else mesh


def _without_cusps(
    surface: Surface, sizing: Sizing
) -> tuple[Surface, SideTopology, tuple[Cusp, ...]]:
    """What is meshed before fans close its cusps, how its sides are joined, and the cusps."""
    sides = find_sides(surface)
    cusps = find_cusps(surface, sides, sizing)
    if not cusps:
        return surface, sides, ()
    part = without_cusps(surface, cusps)
    return part, find_sides(part), cusps


class _Rounds:
    """Rounds with smaller sizes each until nothing is to be mended, or can be."""

    def __init__(
        self, surface: Surface, sides: SideTopology, sizing: Sizing, optimise: bool,
        watch: Stopwatch,
    ) -> None:  # fmt: skip
        self.surface, self.sides, self.sizing = surface, sides, sizing
        self.optimise, self.watch = optimise, watch
        self.chart, self.kinks = Chart.of(surface), kink_lines(surface)
        self.not_followed: list[str] = []
        self._stagnation, self._cells, self._count = StagnationCheck(), 0, 0
        self._latest: tuple[SurfaceMesh, np.ndarray] | None = None

    def mesh(self, limits: Mapping[int, SizeLimits]) -> SurfaceMesh:
        """The mesh of the last round. Raises ``MeshingError`` where its sides are not joined.

        limits: of sizes, known from the start.
        """
        each_counts = self.sizing.proof or self.sizing.is_curved
        rounds = MAX_ROUNDS_FOR_PROOF if each_counts else MAX_ROUNDS
        mesh, bad = refined_in_rounds(self._round, SizeLimits.joined_with, rounds, limits)
        if len(bad):
            place = ", ".join(f"{x:.6g}" for x in mesh.points[bad[0]])
            raise MeshingError(
                f"the sides of {self.surface.name!r} cannot be joined with sizes this coarse: an "
                f"edge near ({place}) has more than two triangles; lower size, max_size or min_size"
            )
        return mesh.with_warnings(*self.not_followed)

    def _round(
        self, limits: Mapping[int, SizeLimits]
    ) -> tuple[tuple[SurfaceMesh, np.ndarray], dict[int, SizeLimits]]:
        """The mesh and its points where sides are not joined; the smaller sizes it needs."""
        self._count += 1
        with self.watch.stage("sizing"):
            try:
                rims, known = Rims(self.surface, self.sides), limits.get(0)
                field = size_field(self.surface, self.sizing, self.sides, known, rims, self.chart)
            except SizingError:
                if self._latest is None:
                    raise
                return self._latest, {}  # what no size can mend: the report says what is left
            cells = len(field.background.child) // 4  # each cell has a row for four parts
            self.watch.spend(cells)
            loops, name = _loops(self.surface), self.surface.name
            require_field_within(self.sizing.limit, field, loops, name)
        try:
            mesh, refinement, bad = self._meshed(field, limits)
        except (SurfaceError, MeshingError) as error:
            if not self.kinks:
                raise
            self.kinks = []
            self.not_followed = [f"no edges follow the kinks of {name!r}: {error}"]
            mesh, refinement, bad = self._meshed(field, limits)
        self._latest = mesh, bad
        self.watch.spend(len(mesh.triangles))
        if refinement is None or not _can_shrink(field, refinement):
            return self._latest, {}
        self._cells += cells
        self._stagnation.record(len(refinement.sizes), len(mesh.triangles))
        too_many = self._cells > max(MOST_CELLS, CELLS_OF_TRIANGLE * len(mesh.triangles))
        may_stop = self.sizing.is_anisotropic or not self._uses_evenly
        if may_stop and (too_many or self._stagnation.is_unchanged):  # the report says what is left
            return self._latest, {}
        return self._latest, {0: refinement}

    @property
    def _uses_evenly(self) -> bool:
        """Even use of the chord undoes smaller sizes: where two rounds do not suffice, the others
        are as without. Stretched triangles are split where they are too far, in all rounds."""
        return self.sizing.uses_evenly and (
            self.sizing.is_anisotropic or self._count <= EVEN_ROUNDS
        )

    def _meshed(
        self, field: SizeField, known: Mapping[int, SizeLimits]
    ) -> tuple[SurfaceMesh, SizeLimits | None, np.ndarray]:
        """The mesh for one size field; the sizes it requests; points where sides are not joined."""
        surface, sides = self.surface, self.sides
        with self.watch.stage("sizing"):
            loops = self._boundary(field)
        patch = mesh_patch(
            surface, self.chart, field, loops,
            optimise=self.optimise, evenly=self._uses_evenly, watch=self.watch,
        )  # fmt: skip
        made, unproved = self._proved(patch)
        mesh = SurfaceMesh(
            points=made.points,
            triangles=made.triangles,
            uv_points=made.uv,
            uv_triangles=made.uv_triangles,
            surfaces=(surface,),
            sizes=made.sizes,
            metric_root_3d=made.roots,
            sizing=field.sizing,
            seconds=self.watch.seconds,
            one_sided=sides.one_sided and not len(surface.loops),
            facts=known_facts(surface),
        )
        unjoined = patch.limits_for_seams(FINER)
        requests = joined(*patch.requests, unjoined, unproved, self._too_far(mesh, patch, known))
        return mesh, requests, patch.space.non_manifold

    def _proved(self, patch: PatchMesh) -> tuple[Patch, SizeLimits | None]:
        """The triangles, and what is asked for where the chord is not proved to hold."""
        space = patch.space
        made = Patch(
            space.points, space.triangles, patch.uv, space.uv_triangles, patch.sizes,
            patch.metric_root_3d,
        )  # fmt: skip
        if not self.optimise or len(space.non_manifold):
            return made, None
        return cut_until_proved(self.surface, self.sizing, made)

    def _too_far(
        self, mesh: SurfaceMesh, patch: PatchMesh, known: Mapping[int, SizeLimits]
    ) -> SizeLimits | None:
        """What is asked for where quadratic triangles keep not to the chord."""
        chord = self.sizing.chord
        if chord is None or not self.sizing.is_curved or len(patch.space.non_manifold):
            return None
        if not self.optimise:
            return None
        return requests_for_curved(mesh, np.array([chord]), self.sizing.gradient, known).get(0)

    def _boundary(self, field: SizeField) -> BoundaryLoops:
        if not self.kinks or not isinstance(self.surface, ParametricSurface):
            return boundary_loops(self.surface, self.sides, field)
        loops = boundary_loops(self.surface, self.sides, field, sides_met(self.surface, self.kinks))
        return with_kinks(loops, self.surface, self.kinks, field)


def estimate_parametric(surface: Surface, sizing: Sizing) -> Estimate:
    """Triangles and memory of ``mesh_parametric``. Raises as it does."""
    balanced = sizing.is_balanced
    if balanced:
        sizing = widened(with_chord_of_surface(surface, sizing)).replaced(vertices=ON_SURFACE)
    part, sides, cusps = _without_cusps(surface, sizing)
    coarseness = COARSENESS_STRETCHED if sizing.is_anisotropic else COARSENESS
    field = size_field(part, sizing, sides, rims=Rims(part, sides), coarseness=coarseness)
    loops = _loops(part)
    least = None
    if field.sizing.chord is not None and not field.sizing.is_curved:
        chord = field.sizing.chord / (WIDER if balanced else 1.0)
        least = least_of_surface(part, field, sides, chord, balanced)
    asked = field_triangles(field, loops)
    foreseen = not cusps and is_one_round(sizing) and largest_turn(part, field) <= LARGEST_TURN
    if asked <= (FEW if foreseen else WHOLE):
        made = counts_within_budget(
            lambda budget: mesh_parametric(surface, sizing, progress=budget)
        )
        if made is not None:
            return Estimate.of(made, field.is_anisotropic, least=least)
    by_direction = field.is_anisotropic or field.sizing.fewest
    plan = WIDE if by_direction else plan_within(LARGEST_FRACTION * asked)
    each = None if plan is None else triangles_per_unit(part, field, loops, plan)
    return Estimate.of([asked * (each or 1.0)], field.is_anisotropic, least=least)


def explain_parametric(surface: Surface, sizing: Sizing, point: np.ndarray) -> Explanation:
    """Which size rule decides at the point of the surface that is nearest to ``point`` (3,)."""
    if sizing.is_balanced:
        sizing = widened(with_chord_of_surface(surface, sizing))
    sides = find_sides(surface)
    field = size_field(surface, sizing, sides, rims=Rims(surface, sides))
    from surfmesh.meshing.explain.explanation import explain_surface

    return explain_surface(surface, sizing, field, point)


def _loops(surface: Surface) -> list[np.ndarray] | None:
    return [np.asarray(loop, float) for loop in surface.loops] or None


def _can_shrink(field: SizeField, requests: SizeLimits) -> bool:
    """Is any requested size still allowed, or do all lie below ``min_size``?"""
    return bool((requests.sizes >= (field.sizing.min_size or 0.0)).any())
