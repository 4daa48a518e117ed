"""What has to hold of every mesh: the first thing that does not, in words."""

import numpy as np

from surfmesh.result.mesh_part import FloatArray, Int32Array
from surfmesh.result.mesh_parts import ModelLinks, Parametrisation


def first_broken(
    points: FloatArray, triangles: Int32Array, sizes: FloatArray | None,
    mid_points: FloatArray | None, corners: Parametrisation | None, links: ModelLinks,
) -> str | None:  # fmt: skip
    """The first broken invariant of a mesh, or None; see ``SurfaceMesh.broken_invariant``."""
    from surfmesh._core.quality import is_sound  # late, as in ``connect``

    uv_triangles = None if corners is None else corners.uv_triangles
    uv_points = None if corners is None else corners.uv_points
    surfaces = len(links.surfaces) or None
    if is_sound(
        points, triangles, sizes, mid_points, uv_points, uv_triangles, links.face_ids, surfaces
    ):
        return None
    outside = _outside("triangles", triangles, len(points))
    if outside is None and corners is not None:
        outside = _outside("uv_triangles", corners.uv_triangles, len(corners.uv_points))
    if outside is not None:
        return outside
    held = {"points": points, "uv_points": uv_points, "sizes": sizes, "mid_points": mid_points}
    for name, array in held.items():
        if array is not None and not np.isfinite(array).all():
            bad = int(np.flatnonzero(~np.isfinite(array).reshape(len(array), -1).all(1))[0])
            return f"{name}[{bad}] = {array[bad].tolist()} is not finite"
    if sizes is not None and len(sizes) and sizes.min() <= 0:
        bad = int(sizes.argmin())
        return f"sizes[{bad}] = {sizes[bad]} is not positive"
    improper = _first_improper(triangles, len(points))
    if improper is not None:
        return improper
    if links.surfaces and len(links.face_ids):
        low, high, count = links.face_ids.min(), links.face_ids.max(), len(links.surfaces)
        if low < 0 or high >= count:
            return f"face_ids run from {low} to {high}, surfaces are {count}"
    return None


def _first_improper(triangles: Int32Array, vertices: int) -> str | None:
    """Of triangles whose numbers are in range."""
    from surfmesh._core.quality import unused_vertex  # late, as in ``connect``

    a, b, c = triangles.T
    repeated = np.flatnonzero((a == b) | (b == c) | (c == a))
    if len(repeated):
        bad = int(repeated[0])
        return f"triangle {bad} = {triangles[bad].tolist()} repeats a corner"
    twin = _first_duplicate(triangles, vertices)
    if twin is not None:
        return f"triangles {twin[0]} and {twin[1]} have the same corners"
    unused = unused_vertex(triangles, vertices)
    return f"vertex {unused} belongs to no triangle" if unused >= 0 else None


def _outside(name: str, indices: Int32Array, limit: int) -> str | None:
    if not indices.size or 0 <= indices.min() <= indices.max() < limit:
        return None
    bad = int(np.flatnonzero(((indices < 0) | (indices >= limit)).any(axis=1))[0])
    return f"{name}[{bad}] = {indices[bad].tolist()} is outside 0..{limit - 1}"


def _first_duplicate(triangles: Int32Array, vertices: int) -> tuple[int, int] | None:
    """Two triangles with the same three corners in any order, or None."""
    from surfmesh._core.quality import has_repeated_triangles  # late, as in ``connect``

    if not has_repeated_triangles(triangles, vertices):
        return None
    a, b, c = triangles.astype(np.int64).T
    low, high = np.minimum(np.minimum(a, b), c), np.maximum(np.maximum(a, b), c)
    middle = a + b + c - low - high
    stride = int(high.max(initial=0)) + 1
    if stride <= 1 << 21:  # the three numbers fit into one
        keys = ((low * stride + middle) * stride + high)[None]
        order = np.argsort(keys[0])
    else:
        keys = np.stack((low, middle, high))
        order = np.lexsort(keys)
    same = np.flatnonzero((keys[:, order[1:]] == keys[:, order[:-1]]).all(axis=0))
    if not len(same):
        return None
    first, second = sorted(int(order[same[0] + i]) for i in (0, 1))
    return first, second
