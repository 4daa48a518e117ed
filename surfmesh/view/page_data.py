"""A mesh as the page of the report takes it: arrays in one compressed text, the rest as JSON."""

import base64
import gzip
from collections.abc import Collection, Iterator
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from surfmesh.result.facets import PARTS, Facets, corner_weights, facets
from surfmesh.result.surface_mesh import SurfaceMesh
from surfmesh.view.camera import direction_of
from surfmesh.view.colour_maps import table_of
from surfmesh.view.colouring import LABELS, Colouring
from surfmesh.view.legend import unit_of
from surfmesh.view.lines import (
    Lines,
    model_edges,
    principal_directions,
    worst_triangles,
)

SWITCHES = ("triangles", "light", "circles", "model edges", "worst", "principal directions")
SHOWN = ("triangles", "model edges", "worst")
"""What of these is switched on when nothing else is said."""

MARKED = 20  # worst triangles
KEPT_BITS = np.uint32(0xFFFFF000)  # of a colour's float: four digits, and the file a third smaller
HALF_BIT = np.uint32(0x800)
LEVEL = 6  # of gzip


class PageData(NamedTuple):
    contents: dict[str, Any]  # ready for JSON
    arrays: str  # base64 of gzip of what contents["arrays"] lists, little-endian


def page_data(
    mesh: SurfaceMesh, colourings: dict[str, Colouring], by: str, shown: Collection[str] = SHOWN
) -> PageData:
    """``mesh`` and its ``colourings`` for the page, which shows ``by`` first, with what
    of ``SWITCHES`` is in ``shown``.

    Points are kept relative to the middle of the mesh, in halves of its largest extent: single
    precision is then enough wherever the mesh lies and however small it is. Quadratic triangles
    have their facets beside them, which are what is drawn.
    """
    flat = None if mesh.mid_points is None else facets(mesh)
    points = mesh.points if flat is None else flat.points
    low, high = points.min(axis=0), points.max(axis=0)
    centre = 0.5 * (low + high)
    scale = 0.5 * float((high - low).max()) or 1.0
    arrays = {
        "points": ((points - centre) / scale).astype("<f4"),
        "triangles": mesh.triangles.astype("<u4"),
        **({} if flat is None else {"facets": flat.triangles.astype("<u4")}),
        "face_ids": np.maximum(mesh.face_ids, 0).astype("<u4"),
    }
    corners = mesh.parametrisation
    if corners is not None and corners.metric_root_3d is not None:  # the page draws ellipses
        arrays["inverse sizes"] = _rounded(corners.metric_root_3d * scale)
        arrays["inverse size rows"] = corners.uv_triangles.astype("<u4")
    elif mesh.sizes is not None:  # or circles
        arrays["sizes"] = _rounded(mesh.sizes / scale)
    entries = []
    for key, found in colourings.items():
        arrays[f"by {key}"] = _rounded(_values(mesh, found, flat))
        entries.append(_menu_entry(key, found))
    lines = []
    for layer, group in _layers(mesh):
        if len(layer.segments):
            arrays[layer.name] = ((layer.segments - centre) / scale).astype("<f4")
            lines.append(_entry(layer, group))
    listed, packed = _packed(arrays)
    contents = {
        "by": by,
        "shown": [name for name in SWITCHES if name in shown],
        "unit": unit_of(mesh),
        "centre": centre.tolist(),
        "scale": scale,
        "sight": direction_of(mesh.points).tolist(),
        "faceNames": [mesh.face_name(i) for i in range(int(mesh.face_ids.max()) + 1)],
        "colourings": entries,
        "lines": lines,
        "weights": corner_weights(1 if flat is None else PARTS).ravel().tolist(),
        "arrays": listed,
    }
    return PageData(contents, packed)


def _values(mesh: SurfaceMesh, found: Colouring, flat: Facets | None) -> NDArray:
    """One a point that is drawn, or one a triangle of the mesh."""
    if flat is None or not found.per_vertex:
        return found.values
    return flat.interpolated(mesh, found.values)


def _menu_entry(key: str, found: Colouring) -> dict[str, Any]:
    return {
        "key": key,
        "label": LABELS[key],
        "title": found.title,
        "array": f"by {key}",
        "perVertex": found.per_vertex,
        "limits": found.limits,
        "logarithmic": found.logarithmic,
        "hues": found.hues,
        "map": table_of(found),
    }


def _layers(mesh: SurfaceMesh) -> Iterator[tuple[Lines, str]]:
    """What is drawn over the triangles, and the switch that it belongs to."""
    yield model_edges(mesh), "model edges"
    yield worst_triangles(mesh, MARKED)[0], "worst"
    if mesh.surfaces and mesh.uv_points is not None:
        for layer in principal_directions(mesh):
            yield layer, "principal directions"


def _entry(layer: Lines, group: str) -> dict[str, Any]:
    return {
        "array": layer.name,
        "group": group,
        "colour": layer.colour,
        "width": 0.6 * layer.width,  # of a screen, where pictures are drawn larger
    }


def _rounded(values: NDArray) -> NDArray[np.float32]:
    """Single precision with the last bits cleared."""
    bits = np.asarray(values, "<f4").view("<u4")
    return ((bits + HALF_BIT) & KEPT_BITS).view("<f4")


def _packed(arrays: dict[str, NDArray]) -> tuple[list[dict[str, Any]], str]:
    listed, start = [], 0
    for name, values in arrays.items():
        kind = values.dtype.str[1:]
        listed.append({"name": name, "kind": kind, "start": start, "length": values.size})
        start += values.nbytes
    whole = b"".join(np.ascontiguousarray(values).tobytes() for values in arrays.values())
    # without a time, so that the same mesh gives the same file
    return listed, base64.b64encode(gzip.compress(whole, LEVEL, mtime=0)).decode("ascii")
