"""Pictures of a circle packing, as in the paper's figures 6 to 10: circles, mesh, or both."""

from io import BytesIO
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from surfmesh.errors import FileFormatError, SizingError, needs
from surfmesh.io.atomic import replacing
from surfmesh.view.legend import INK

if TYPE_CHECKING:
    from surfmesh.circle_packing import CirclePacking

SHOWN = ("circles", "mesh", "both")
FORMATS = (".svg", ".png")
_NOT_SAID = {".svg": {"Date": None, "Creator": None}, ".png": {"Software": None}}
INCHES, DOTS_PER_INCH = 10, 150
POINTS_A_LINE = 0.06  # of the mean radius on paper: lines stay thinner than what they outline


def draw_packing(packing: "CirclePacking", path: str | Path, show: str = "both") -> Path:
    """Write the circles, the mesh or both of them to ``path``, .svg or .png.

    Ellipses are drawn where the packing has a tensor field. Raises ``FileFormatError`` for
    another extension or a place that cannot be written, ``SizingError`` for an unknown
    ``show``.
    """
    with needs("view", "a drawing"):
        from matplotlib import rc_context
        from matplotlib.backends.backend_agg import FigureCanvasAgg
        from matplotlib.collections import EllipseCollection, LineCollection
        from matplotlib.figure import Figure

    path = Path(path)
    if path.suffix.lower() not in FORMATS:
        raise FileFormatError(
            f"{path}: packings are drawn as {' or '.join(FORMATS)}, not '{path.suffix}'"
        )
    if show not in SHOWN:
        raise SizingError(f"show is one of {', '.join(SHOWN)}, not {show!r}")
    major, minor, turn = _axes(packing.tensors, packing.radii)
    low = (packing.centres - major[:, None]).min(axis=0)
    high = (packing.centres + major[:, None]).max(axis=0)
    width, height = high - low
    figure = Figure(figsize=(INCHES, INCHES * height / width), dpi=DOTS_PER_INCH)
    FigureCanvasAgg(figure)
    axes = figure.add_axes((0.0, 0.0, 1.0, 1.0))
    axes.set(xlim=(low[0], high[0]), ylim=(low[1], high[1]))
    axes.axis("off")
    thin = float(np.clip(POINTS_A_LINE * packing.radii.mean() / width * INCHES * 72, 0.05, 0.8))
    if show != "mesh":
        axes.add_collection(
            EllipseCollection(
                2.0 * major, 2.0 * minor, np.degrees(turn), units="xy", offsets=packing.centres,
                offset_transform=axes.transData, facecolors="#f2c14e55", edgecolors="#b07d10",
                linewidths=thin,
            )
        )  # fmt: skip
    if show != "circles":
        edges = packing.triangles[:, [[0, 1], [1, 2], [2, 0]]].reshape(-1, 2)
        edges = np.unique(np.sort(edges, axis=1), axis=0)
        lines = LineCollection(packing.centres[edges], colors=INK, linewidths=thin)
        axes.add_collection(lines)
    with replacing(path) as temporary, rc_context({"svg.hashsalt": "surfmesh"}):
        picture, kind = BytesIO(), path.suffix.lower()
        figure.savefig(picture, format=kind[1:], metadata=_NOT_SAID[kind])
        temporary.write_bytes(picture.getbuffer())
    return path


def _axes(h: np.ndarray, radii: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Half axes and direction of the ellipses; circles keep the radius they got."""
    mean, spread = 0.5 * (h[:, 0] + h[:, 2]), np.hypot(0.5 * (h[:, 0] - h[:, 2]), h[:, 1])
    scale = radii / np.sqrt(np.maximum(mean**2 - spread**2, np.finfo(float).tiny))
    turn = 0.5 * np.arctan2(2.0 * h[:, 1], h[:, 0] - h[:, 2])
    return (mean + spread) * scale, (mean - spread) * scale, turn
