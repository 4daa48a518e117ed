"""The rows of faces in a report: columns at once, one object a face when it is asked for."""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from typing import Any, NamedTuple, SupportsIndex, overload

import numpy as np
from numpy.typing import NDArray

from surfmesh.geometry.surface import surface_kind
from surfmesh.quality.measures.by_solid import relative_error
from surfmesh.quality.measures.places import Point, as_point
from surfmesh.quality.measures.tolerances import Tolerances
from surfmesh.result.model_facts import FaceFacts
from surfmesh.result.surface_mesh import SurfaceMesh


@dataclass(frozen=True, kw_only=True)
class FaceRow:
    """Lengths and areas in model units. None: not known."""

    face: int
    name: str
    kind: str  # plane, cylinder, ...; empty when it is none of those
    triangles: int
    area: float
    area_exact: float | None
    area_error: float | None  # area / area_exact - 1
    chord: float | None  # asked for: the largest distance from the surface
    angle: float | None  # likewise the largest between its triangles, degrees
    limit: str  # a min_size of the user's that forbids one of them, in words; else empty
    deviation_max: float | None
    deviation_rms: float | None
    deviation_triangle: int | None  # where deviation_max is
    deviation_point: Point | None  # its centroid
    above_chord_share: float | None  # of its triangles that are farther away than its chord
    angle_max: float | None  # largest between its triangles that share an edge, degrees
    above_angle_share: float | None  # of the edges within it, above its angle
    folded: int | None  # triangles turned more than 60 degrees from the surface
    alpha_mean: float | None  # None where the face has no triangle
    alpha_min: float | None
    size_mean: float | None  # mean edge length that was reached
    size_wanted: float | None  # mean target size of the same edges


class FaceDeviations(NamedTuple):
    """By face (f,)."""

    largest: NDArray[np.float64]
    worst: NDArray[np.int32]  # the triangle where that is
    places: NDArray[np.float64]  # (f, 3) the centroids of these
    square: NDArray[np.float64]  # mean square times area
    above: NDArray[np.int64]  # triangles farther away than the chord
    folded: NDArray[np.intp]  # triangles


class FaceDihedrals(NamedTuple):
    """By face (f,)."""

    largest: NDArray[np.float64]
    above: NDArray[np.intp]  # edges
    edges: NDArray[np.intp]  # within the face


@dataclass(frozen=True, kw_only=True)
class FaceColumns:
    """The figures of all faces (f,). None stands for what is not known of any."""

    mesh: SurfaceMesh
    numbers: NDArray[np.integer[Any]]
    facts: Sequence[FaceFacts]  # of the model's, as far as it is known
    triangles: NDArray[np.int64]
    area: NDArray[np.float64]
    alpha_sum: NDArray[np.float64]
    alpha_min: NDArray[np.float64]
    size: NDArray[np.float64]
    target: NDArray[np.float64]
    fits: FaceDeviations | None
    dihedrals: FaceDihedrals | None
    tolerances: Tolerances
    limits: dict[int, list[str]]

    @property
    def area_exact(self) -> NDArray[np.float64]:
        """(f,) NaN where it is not known."""
        areas = np.full(len(self.numbers), np.nan)
        of_model = np.array([one.area or np.nan for one in self.facts], float)
        there = np.flatnonzero((self.numbers >= 0) & (self.numbers < len(of_model)))
        areas[there] = of_model[self.numbers[there]]
        return areas

    def row(self, k: int) -> FaceRow:
        """What stands in row k."""
        mesh, face, asked = self.mesh, int(self.numbers[k]), self.tolerances
        known = self.facts[face] if 0 <= face < len(self.facts) else None
        here, area = int(self.triangles[k]), float(self.area[k])
        exact = None if known is None else known.area
        chord, angle = asked.one(asked.chord, face), asked.one(asked.angle, face)
        kind = surface_kind(mesh.surfaces[face]) if mesh.surfaces else ""
        fit = self.fits if here else None
        rms = (float(fit.square[k]) / area) ** 0.5 if fit and area > 0 else None
        dihedral = self.dihedrals
        if dihedral is not None and not dihedral.edges[k]:
            dihedral = None
        above_angle = (
            float(dihedral.above[k] / dihedral.edges[k]) if dihedral is not None and angle else None
        )
        return FaceRow(
            face=face,
            name=mesh.face_name(face),
            kind=kind if known is None else known.kind,
            triangles=here,
            area=area,
            area_exact=exact,
            area_error=relative_error(area, exact) if here else None,
            chord=chord,
            angle=angle,
            limit="; ".join(self.limits.get(face, ())),
            deviation_max=None if fit is None else float(fit.largest[k]),
            deviation_rms=rms,
            deviation_triangle=None if fit is None else int(fit.worst[k]),
            deviation_point=None if fit is None else as_point(fit.places[k]),
            above_chord_share=float(fit.above[k] / here) if fit is not None and chord else None,
            angle_max=float(dihedral.largest[k]) if dihedral is not None else None,
            above_angle_share=above_angle,
            folded=None if fit is None else int(fit.folded[k]),
            alpha_mean=float(self.alpha_sum[k] / here) if here else None,
            alpha_min=float(self.alpha_min[k]) if here else None,
            size_mean=float(self.size[k]) if here else None,
            size_wanted=float(self.target[k]) if here and mesh.sizes is not None else None,
        )


class FaceRows(Sequence[FaceRow]):
    """The rows of all faces. Pickled as a tuple of them: surfaces stay behind."""

    def __init__(self, columns: FaceColumns | None = None) -> None:
        """Without columns there are none."""
        self._columns = columns
        self._rows: tuple[FaceRow, ...] | None = None

    def __len__(self) -> int:
        return 0 if self._columns is None else len(self._columns.numbers)

    @overload
    def __getitem__(self, index: SupportsIndex) -> FaceRow: ...
    @overload
    def __getitem__(self, index: slice) -> tuple[FaceRow, ...]: ...
    def __getitem__(self, index: SupportsIndex | slice) -> FaceRow | tuple[FaceRow, ...]:
        return self.rows[index]

    def __iter__(self) -> Iterator[FaceRow]:
        return iter(self.rows)

    def __eq__(self, other: object) -> bool:
        return isinstance(other, (FaceRows, tuple)) and self.rows == tuple(other)

    def __hash__(self) -> int:
        return hash(self.rows)

    def __repr__(self) -> str:
        return repr(self.rows)

    def __reduce__(self) -> tuple[Any, ...]:
        return tuple, (self.rows,)

    @property
    def rows(self) -> tuple[FaceRow, ...]:
        """All of them."""
        if self._rows is None:
            columns, count = self._columns, len(self)
            self._rows = () if columns is None else tuple(map(columns.row, range(count)))
        return self._rows

    @property
    def numbers(self) -> NDArray[np.integer[Any]]:
        """(f,) of the faces."""
        return np.empty(0, np.intp) if self._columns is None else self._columns.numbers

    @property
    def area(self) -> NDArray[np.float64]:
        """(f,) of the triangles of each face."""
        return np.empty(0) if self._columns is None else self._columns.area

    @property
    def area_exact(self) -> NDArray[np.float64]:
        """(f,) NaN where it is not known, or the face has no triangle."""
        if self._columns is None:
            return np.empty(0)
        return np.where(self._columns.triangles > 0, self._columns.area_exact, np.nan)
