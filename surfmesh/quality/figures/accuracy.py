"""How closely the mesh follows its surfaces."""

from dataclasses import dataclass

import numpy as np

from surfmesh.geometry.functions.numeric import NumericSurface
from surfmesh.quality.figures.part import Part
from surfmesh.quality.measures.dihedral import largest_angle
from surfmesh.quality.measures.measurements import Measurements
from surfmesh.quality.measures.places import Point
from surfmesh.quality.measures.tolerances import exceeds_angle
from surfmesh.quality.measures.unseen import UnseenPlace


@dataclass(frozen=True, kw_only=True)
class DeviationFigures(Part):
    """Distances, as sampled, in model units. None: no surface is known, or nothing was asked."""

    chord: float | None  # the largest deviation that was asked for, of the whole model
    deviation_max: float | None  # of the mesh from the true surface
    deviation_rms: float | None
    deviation_triangle: int | None  # where deviation_max is
    deviation_point: Point | None
    deviation_uv: tuple[float, float] | None
    surface_deviation_max: float | None  # the other way: of the true surface from the mesh
    surface_deviation_triangle: int | None  # over which it is
    surface_deviation_point: Point | None  # of the true surface
    surface_deviation_uv: tuple[float, float] | None
    surface_deviation_at_rim: bool | None  # is that point on a free rim of the surface?
    deviation_two_sided: float | None  # the larger of both: the Hausdorff distance, as sampled
    above_chord_share: float | None  # triangles farther away than the chord of their face

    @classmethod
    def of(cls, measured: Measurements) -> "DeviationFigures":
        """Both ways."""
        fit, back, tolerances = (
            measured.deviation, measured.surface_deviation, measured.tolerances,
        )  # fmt: skip
        above = None
        if measured.beyond_chord is not None and np.isfinite(tolerances.chord).any():
            above = float(np.mean(measured.beyond_chord))
        sizing = measured.mesh.sizing
        two_sided = None if fit is None or back is None else max(fit.largest, back.largest)
        return cls(
            chord=(None if sizing is None else sizing.chord) or tolerances.base_chord,
            deviation_max=None if fit is None else fit.largest,
            deviation_rms=None if fit is None else fit.rms,
            deviation_triangle=None if fit is None else fit.triangle,
            deviation_point=None if fit is None else fit.point,
            deviation_uv=None if fit is None else fit.uv,
            surface_deviation_max=None if back is None else back.largest,
            surface_deviation_triangle=None if back is None else back.triangle,
            surface_deviation_point=None if back is None else back.point,
            surface_deviation_uv=None if back is None else back.uv,
            surface_deviation_at_rim=None if back is None else back.at_rim,
            deviation_two_sided=two_sided,
            above_chord_share=above,
        )


@dataclass(frozen=True, kw_only=True)
class BetweenSamples(Part):
    """What no sample has seen."""

    unseen: int | None  # triangles between whose samples a formula's bounds admit more than was
    # seen, or more was found; None: nothing is known between the samples (functions, CAD faces)
    unseen_max: float | None  # how far that lies, or may lie, from the mesh; infinite: no bound
    unseen_at: tuple[UnseenPlace, ...]  # the first twenty
    functions: int  # faces given by a Python function: features narrower than the triangles cannot
    # be excluded there, nor are they looked for

    @classmethod
    def of(cls, measured: Measurements) -> "BetweenSamples":
        """Found, or not to be excluded."""
        seen = None if measured.unseen is None else measured.unseen.total
        surfaces = measured.mesh.surfaces
        return cls(
            unseen=None if seen is None else seen.found + seen.open,
            unseen_max=None if seen is None else max(seen.largest, seen.possible),
            unseen_at=() if seen is None else seen.places,
            functions=sum(isinstance(surface, NumericSurface) for surface in surfaces),
        )


@dataclass(frozen=True, kw_only=True)
class ChordUseFigures(Part):
    """How much of the chord is used, where it decides the size."""

    chord_used: float | None  # median of deviation / chord there
    chord_decided_share: float | None  # of the triangles: where no other size rule did

    @classmethod
    def of(cls, measured: Measurements) -> "ChordUseFigures":
        """None where no chord was asked for, or nothing is known."""
        use = measured.chord_use
        if use is None:
            return cls(chord_used=None, chord_decided_share=None)
        return cls(chord_used=use.used, chord_decided_share=use.fraction)


@dataclass(frozen=True, kw_only=True)
class EfficiencyFigures(Part):
    """How many triangles there are beside the least that ``chord`` needs.

    None where no chord was asked for, nothing is known, or triangles are quadratic. A mesh may have
    fewer than the least: that holds for a small chord, not for a few triangles.
    """

    least_triangles: float | None  # of any shape and size: see measures/least_triangles.py
    efficiency: float | None  # least_triangles / triangles
    equilateral_triangles: float | None  # the same of equilateral ones, in directions at random;
    # None too where sizes depend on the direction, and of balanced vertices

    @classmethod
    def of(cls, measured: Measurements) -> "EfficiencyFigures":
        """Of the whole mesh."""
        found, count = measured.least_triangles, len(measured.mesh.triangles)
        if found is None:
            return cls(least_triangles=None, efficiency=None, equilateral_triangles=None)
        return cls(
            least_triangles=found.least,
            efficiency=found.least / count,
            equilateral_triangles=found.equilateral,
        )


@dataclass(frozen=True, kw_only=True)
class DihedralFigures(Part):
    """Angles between triangles that share an edge within a face, degrees."""

    angle: float | None  # asked for; None: only 45 as a rule of sizes, no tolerance
    angle_max: float | None
    angle_triangles: tuple[int, int] | None  # where it is: not where the surface has a crease
    angle_point: Point | None  # middle of the edge
    above_angle_share: float | None  # of the edges within faces, above the angle of their face

    @classmethod
    def of(cls, measured: Measurements) -> "DihedralFigures":
        """None where no surface is known, or a face has no inner edge."""
        dihedrals, tolerances = measured.dihedral_angles, measured.tolerances
        worst = None if dihedrals is None else largest_angle(measured.mesh, dihedrals)
        above = None
        if dihedrals is not None and worst is not None and np.isfinite(tolerances.angle).any():
            exceeding = np.count_nonzero(exceeds_angle(tolerances, dihedrals))
            above = float(exceeding / dihedrals.number.sum())
        sizing = measured.mesh.sizing
        largest, triangles, point = (None, None, None) if worst is None else worst
        return cls(
            angle=(None if sizing is None else sizing.angle) or tolerances.base_angle,
            angle_max=largest,
            angle_triangles=triangles,
            angle_point=point,
            above_angle_share=above,
        )
