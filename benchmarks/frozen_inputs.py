"""The inputs of ``frozen_meshes.py``, and the mesh of one of them in a process of its own."""

import single_thread  # noqa: F401  (before numpy)

# isort: split
from collections.abc import Callable
from time import process_time
from typing import Any

import child_process
import numpy as np

import surfmesh as sm
from surfmesh.cad.model.cad_model import CadModel

STRETCHED = 8.0  # the ratio of the stretched meshes
COARSE = 200.0  # the diagonal over the chord


def _circle(radius: float, count: int, x: float = 0.0, y: float = 0.0) -> np.ndarray:
    angles = np.linspace(0.0, 2.0 * np.pi, count, endpoint=False)
    return np.column_stack((x + radius * np.cos(angles), y + radius * np.sin(angles)))


def _square() -> Any:
    return sm.PlanarDomain([[0, 0], [1, 0], [1, 1], [0, 1]]), sm.Sizing(size=0.05)


def _plate() -> Any:
    """A disc with three holes, one of them near its rim, and a line that the mesh follows."""
    holes = [_circle(0.2, 40), _circle(0.1, 24, 0.6, 0.3), _circle(0.05, 16, -0.93)]
    line = [[-0.5, -0.6], [0.0, -0.4], [0.5, -0.6]]
    return sm.PlanarDomain(_circle(1.0, 120), holes, [line], [[0.3, 0.7]]), None


def _comb() -> Any:
    """Narrow teeth beside one another."""
    teeth = [[x + dx, y] for x in range(10) for dx, y in ((0, 5), (0.7, 5), (0.7, 0), (1, 0))]
    return sm.PlanarDomain([[0, -1], *teeth, [10, -1]]), sm.Sizing(size=0.8)


DOMAINS: dict[str, Callable[[], Any]] = {"square": _square, "plate": _plate, "comb": _comb}


def _meshed(request: dict[str, Any]) -> dict[str, Any]:
    """The mesh of one input, as a digest, or why there is none."""
    start = process_time()
    try:
        subject, sizing = _subject(request)
        mesh = sm.mesh(subject, sizing, **_unstrict(subject))
        answer = {"sha256": mesh.report.mesh_sha256, "triangles": len(mesh.triangles)}
    except sm.errors.SurfmeshError as error:
        answer = {"error": " ".join(str(error).split())}
    return {**answer, "seconds": round(process_time() - start, 2)}


def _subject(request: dict[str, Any]) -> tuple[Any, Any]:
    """A surface, model or domain, and its sizes."""
    if "domain" in request:
        return DOMAINS[request["domain"]]()
    if "gallery" in request:
        from surfmesh.geometry.files.surface_file import gallery

        subject = sm.load(gallery()[request["gallery"]])
    elif "part" in request:
        from cad_parts import part

        subject = sm.from_cadquery(part(request["part"]))
    else:
        subject = sm.load(request["file"])
    if request["way"] == "default":
        return subject, None
    chord = _diagonal(subject) / COARSE
    stretched = {"anisotropy": STRETCHED} if request["way"] == "stretched" else {}
    return subject, sm.Sizing(chord=chord, **stretched)


def _diagonal(subject: Any) -> float:
    """Of the box around a surface's samples, or around a model."""
    if isinstance(subject, CadModel):
        return float(subject.diagonal)
    low, high = np.array(subject.domain, float).T
    ticks = np.linspace(0.0, 1.0, 33)[:, None]
    u, v = (low + (high - low) * ticks).T
    uv = np.column_stack([grid.ravel() for grid in np.meshgrid(u, v)])
    points = subject.evaluate(uv, 0)[0]
    points = points[np.isfinite(points).all(axis=1)]
    return float(np.linalg.norm(np.ptp(points, axis=0)))


def _unstrict(subject: Any) -> dict[str, bool]:
    return {"strict": False} if isinstance(subject, CadModel) else {}


if __name__ == "__main__":
    child_process.answer(_meshed)
