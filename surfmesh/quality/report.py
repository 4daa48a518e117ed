"""The report: one object with every figure, a verdict, and sentences for what is wrong."""

import json
import math
from collections.abc import Mapping
from dataclasses import asdict, dataclass, fields, is_dataclass
from time import perf_counter
from typing import Any

import numpy as np
from numpy.typing import NDArray

from surfmesh.quality.deviation import Deviation, deviation
from surfmesh.quality.lengths import QUASI_UNIT, edge_lengths, growth, metric_lengths
from surfmesh.quality.shape import Shapes, enclosed_volume, metric_alpha, shapes
from surfmesh.quality.solids import shares_faces, solid_mesh
from surfmesh.quality.topology import Topology, topology
from surfmesh.surface_mesh import NOT_MESHED, SurfaceMesh

SCHEMA_VERSION = 1  # of to_dict(): raised when a field changes its meaning or goes away
DEGENERATE = 1e-6  # alpha below which a triangle has no area to speak of
FOLDED, INVERTED = math.cos(math.radians(60.0)), 0.0  # cosines between the two normals
CHORD_SLACK = 1e-9  # relative: rounding in the distance itself


@dataclass(frozen=True, kw_only=True)
class Report:
    """What ``check`` found. None stands for what cannot be known, such as the volume of an
    open mesh. Lengths, areas and volumes are in model units, angles in degrees.
    """

    schema_version: int
    surface: str  # names of the surfaces
    nodes: int
    triangles: int
    faces: int

    euler: int  # V - E + F
    closed: bool  # no boundary edge
    manifold: bool  # every edge in one or two triangles, every vertex in one fan of them
    oriented: bool  # neighbours run along their common edge in opposite directions
    one_sided: bool  # by nature of the surface: no orientation is demanded
    components: int
    boundary_loops: int

    alpha_mean: float  # 4 sqrt(3) area / sum of squared edges, in 3D; 1 is equilateral
    alpha_p01: float  # 1 % of the triangles are worse
    alpha_min: float
    alpha_metric_mean: float | None  # the same in the wanted metric, where that is anisotropic
    alpha_metric_min: float | None
    radius_ratio_mean: float  # 2 r_in / r_circum; 1 is equilateral
    radius_ratio_min: float
    min_angle_deg: float
    max_angle_deg: float
    degenerate: int  # triangles with alpha below 1e-6
    folded: int | None  # triangles turned more than 60 degrees from the surface, inverted too
    inverted: int | None  # triangles turned more than 90 degrees from the surface

    edge_min: float
    edge_mean: float
    edge_max: float
    quasi_unit_share: float | None  # edges within [1/sqrt 2, sqrt 2] of the wanted length
    length_mean: float | None  # of length / wanted length, over all edges
    length_std: float | None
    length_min: float | None
    length_max: float | None
    growth_max: float  # longest over shortest edge at a vertex; in wanted lengths where those
    # depend on the direction
    growth_p99: float

    chord: float | None  # the largest deviation that was asked for
    deviation_max: float | None  # from the true surface
    deviation_rms: float | None
    deviation_triangle: int | None  # where deviation_max is
    deviation_point: tuple[float, float, float] | None
    deviation_uv: tuple[float, float] | None
    above_chord_share: float | None  # triangles farther away than chord

    area: float
    volume: float | None  # of a closed, oriented mesh
    seconds: Mapping[str, float]  # by stage
    warnings: tuple[str, ...]
    options: Mapping[str, Any]  # the sizing it was made with
    problems: tuple[str, ...]  # why it is not clean

    @property
    def clean(self) -> bool:
        """Whether the mesh can be used as it is."""
        return not self.problems

    def to_dict(self) -> dict[str, Any]:
        """Plain numbers, strings and lists, ``clean`` included; ready for JSON."""
        values = {item.name: getattr(self, item.name) for item in fields(self)}
        return _plain(
            {"schema_version": values.pop("schema_version"), "clean": self.clean} | values
        )

    def to_json(self, indent: int | None = 2) -> str:
        """JSON text; numbers that are not finite become null."""
        return json.dumps(self.to_dict(), indent=indent, ensure_ascii=False, allow_nan=False)

    def __str__(self) -> str:
        from surfmesh.quality.summary import summary

        return summary(self)


def check(mesh: SurfaceMesh) -> Report:
    """Look at everything that can be said of ``mesh``: topology, shape, sizes, deviation.

    Raises ``ValueError`` when its indices are out of range; everything else that is wrong is
    in ``report.problems``.
    """
    start = perf_counter()
    broken = mesh.check()
    if broken and "is outside" in broken:
        raise ValueError(f"this is not a mesh: {broken}")
    finite = bool(np.isfinite(mesh.points).all())
    topo, shape = topology(mesh), shapes(mesh)
    lengths = edge_lengths(mesh)
    metric = None if mesh.sizes is None else metric_lengths(mesh, lengths)
    grown = growth(mesh, lengths if mesh.inverse_sizes is None else metric)
    wanted = None if mesh.inverse_sizes is None else metric_alpha(mesh)
    fit = deviation(mesh, shape.area) if finite else None
    chord = getattr(mesh.sizing, "chord", None)
    encloses = topo.closed and topo.manifold and topo.oriented
    unit_share = None
    if metric is not None and len(metric):
        low, high = QUASI_UNIT
        unit_share = float(np.count_nonzero((metric >= low) & (metric <= high)) / len(metric))
    faces = len(mesh.surfaces) or int(mesh.face_ids.max(initial=-1)) + 1
    above = None
    if fit is not None and chord is not None:
        above = float(np.mean(fit.by_triangle > chord * (1 + CHORD_SLACK)))
    return Report(
        schema_version=SCHEMA_VERSION,
        surface=_names(mesh),
        nodes=len(mesh.points),
        triangles=len(mesh.triangles),
        faces=faces,
        euler=topo.euler,
        closed=topo.closed,
        manifold=topo.manifold,
        oriented=topo.oriented,
        one_sided=mesh.one_sided,
        components=topo.components,
        boundary_loops=topo.boundary_loops,
        alpha_mean=_over(np.mean, shape.alpha),
        alpha_p01=_over(lambda alpha: np.quantile(alpha, 0.01), shape.alpha),
        alpha_min=_over(np.min, shape.alpha),
        alpha_metric_mean=None if wanted is None else _over(np.mean, wanted),
        alpha_metric_min=None if wanted is None else _over(np.min, wanted),
        radius_ratio_mean=_over(np.mean, shape.radius_ratio),
        radius_ratio_min=_over(np.min, shape.radius_ratio),
        min_angle_deg=_over(np.min, shape.min_angle),
        max_angle_deg=_over(np.max, shape.max_angle),
        degenerate=int(np.count_nonzero(~(shape.alpha > DEGENERATE))),
        folded=None if fit is None else int(np.count_nonzero(fit.cosine < FOLDED)),
        inverted=None if fit is None else int(np.count_nonzero(fit.cosine < INVERTED)),
        edge_min=_over(np.min, lengths),
        edge_mean=_over(np.mean, lengths),
        edge_max=_over(np.max, lengths),
        quasi_unit_share=unit_share,
        length_mean=None if metric is None else _over(np.mean, metric),
        length_std=None if metric is None else _over(np.std, metric),
        length_min=None if metric is None else _over(np.min, metric),
        length_max=None if metric is None else _over(np.max, metric),
        growth_max=grown.largest,
        growth_p99=grown.p99,
        chord=chord,
        deviation_max=None if fit is None else fit.largest,
        deviation_rms=None if fit is None else fit.rms,
        deviation_triangle=None if fit is None else fit.triangle,
        deviation_point=None if fit is None else fit.point,
        deviation_uv=None if fit is None else fit.uv,
        above_chord_share=above,
        area=float(shape.area.sum()),
        volume=_volume(mesh, encloses) if finite and not broken else None,
        warnings=mesh.warnings,
        options=_options(mesh.sizing),
        problems=tuple(_problems(mesh, broken, topo, shape, fit, chord, above)),
        seconds={**mesh.seconds, "check": perf_counter() - start},
    )


def _volume(mesh: SurfaceMesh, encloses: bool) -> float | None:
    """Of what the mesh encloses; where solids share faces, the sum over the solids."""
    if not shares_faces(mesh):
        return enclosed_volume(mesh) if encloses else None
    parts = [solid_mesh(mesh, k) for k in range(int(mesh.solid_ids.max()) + 1)]
    kinds = [topology(part) for part in parts]
    if not all(kind.closed and kind.manifold and kind.oriented for kind in kinds):
        return None
    return sum(enclosed_volume(part) for part in parts)


def _over(measure: Any, values: NDArray[np.float64]) -> float:
    return float(measure(values)) if len(values) else float("nan")


def _names(mesh: SurfaceMesh) -> str:
    names = list(dict.fromkeys(mesh.face_name(i) for i in range(len(mesh.surfaces))))
    return ", ".join(names[:3]) + (f" and {len(names) - 3} more" if len(names) > 3 else "")


def _options(sizing: Any) -> dict[str, Any]:
    if not is_dataclass(sizing):
        return {} if sizing is None else {"sizing": repr(sizing)}
    return {item.name: getattr(sizing, item.name) for item in fields(sizing)}


def _problems(
    mesh: SurfaceMesh,
    broken: str | None,
    topo: Topology,
    shape: Shapes,
    fit: Deviation | None,
    chord: float | None,
    above: float | None,
) -> list[str]:
    """One sentence for each thing that is wrong: how many, and where the first is."""
    said = []
    if not len(mesh.triangles):
        said.append("the mesh has no triangles")
    if broken:
        said.append(broken)
    said += [warning for warning in mesh.warnings if warning.startswith(NOT_MESHED)]
    if shares_faces(mesh):  # three triangles and more may meet where solids do
        for solid in range(int(mesh.solid_ids.max()) + 1):
            part = solid_mesh(mesh, solid)
            around = topology(part)
            bad = [name for name in ("closed", "manifold", "oriented") if not getattr(around, name)]
            if bad:
                said.append(f"solid {solid} is not {' and not '.join(bad)}")
        topo = topo._replace(
            crowded_edges=topo.crowded_edges[:0],
            pinched_vertices=topo.pinched_vertices[:0],
            clashing_edges=topo.clashing_edges[:0],
        )
    if len(topo.crowded_edges):
        first = mesh.edges[topo.crowded_edges[0]]
        many = _number(topo.crowded_edges, "edge")
        said.append(f"{many} shared by more than two triangles, first {_edge(mesh, first)}")
    if len(topo.pinched_vertices):
        first = int(topo.pinched_vertices[0])
        many = _number(topo.pinched_vertices, "vertex", "vertices")
        said.append(f"{many} where parts only touch, first {first} at {_place(mesh.points[first])}")
    if len(topo.clashing_edges) and not mesh.one_sided:
        first = mesh.edges[topo.clashing_edges[0]]
        many = _number(topo.clashing_edges, "edge")
        said.append(f"{many} between triangles of opposite orientation, first {_edge(mesh, first)}")
    said += _triangles(mesh, ~(shape.alpha > DEGENERATE), "without area")
    if fit is not None:
        said += _triangles(mesh, fit.cosine < INVERTED, "inverted against the surface")
        half = (fit.cosine >= INVERTED) & (fit.cosine < FOLDED)
        said += _triangles(mesh, half, "folded: turned more than 60° from the surface")
        if not math.isfinite(fit.largest):
            said.append("the distance from the surface is not finite")
        elif chord is not None and fit.largest > chord * (1 + CHORD_SLACK):
            said.append(
                f"the mesh lies up to {fit.largest:.4g} from the surface, {chord:.4g} was asked "
                f"for ({100 * (above or 0):.3g} % of the triangles are farther); "
                f"worst in triangle {fit.triangle} at {_place(fit.point)}"
            )
    return said


def _triangles(mesh: SurfaceMesh, bad: NDArray[np.bool_], what: str) -> list[str]:
    found = np.flatnonzero(bad)
    if not len(found):
        return []
    first = int(found[0])
    place = _place(mesh.points[mesh.triangles[first]].mean(axis=0))
    return [f"{_number(found, 'triangle')} {what}, first {first} at {place}"]


def _number(found: NDArray, one: str, many: str | None = None) -> str:
    return f"{len(found):,} {one if len(found) == 1 else many or one + 's'}"


def _edge(mesh: SurfaceMesh, edge: NDArray[np.int32]) -> str:
    middle = mesh.points[edge].mean(axis=0)
    return f"{int(edge[0])}-{int(edge[1])} at {_place(middle)}"


def _place(point: Any) -> str:
    return "(" + ", ".join(f"{float(value):.5g}" for value in point) + ")"


def _plain(value: Any) -> Any:
    """``value`` as JSON knows it; callables and other objects by their repr."""
    if isinstance(value, Mapping):
        return {str(key): _plain(item) for key, item in value.items()}
    if isinstance(value, (list, tuple, np.ndarray)):
        return [_plain(item) for item in value]
    if value is None or isinstance(value, (bool, str)):
        return value
    if isinstance(value, (int, np.integer)):
        return int(value)
    if isinstance(value, (float, np.floating)):
        return float(value) if math.isfinite(value) else None
    if is_dataclass(value) and not isinstance(value, type):
        return _plain(asdict(value))
    return repr(value)
