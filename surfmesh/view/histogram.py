"""A histogram as SVG that stands in an HTML page."""

from html import escape

import numpy as np
from numpy.typing import NDArray

BINS = 40
WIDTH, HEIGHT = 360, 96  # of the whole; units of the SVG
LEFT, TOP, BOTTOM = 4, 18, 18
FILL = "#3a7ca5"


def histogram(
    values: NDArray, title: str, limits: tuple[float, float], logarithmic: bool = False
) -> str:
    """SVG of how many ``values`` lie where within ``limits``; beyond them, in the end bars."""
    low, high = limits
    values = np.clip(values[np.isfinite(values)], low, high)
    edges = np.geomspace(low, high, BINS + 1) if logarithmic else np.linspace(low, high, BINS + 1)
    edges[[0, -1]] = low, high
    counts = np.histogram(values, edges)[0]
    room, step = HEIGHT - TOP - BOTTOM, (WIDTH - 2 * LEFT) / BINS
    tallest = max(int(counts.max(initial=0)), 1)
    bars = []
    for k, count in enumerate(counts.tolist()):
        if count:
            tall = max(room * count / tallest, 0.75)  # what is there can be seen
            said = f"{edges[k]:.4g} to {edges[k + 1]:.4g}: {count:,}"
            bars.append(
                f'<rect x="{LEFT + k * step:.2f}" y="{HEIGHT - BOTTOM - tall:.2f}" '
                f'width="{step - 0.8:.2f}" height="{tall:.2f}"><title>{said}</title></rect>'
            )
    base, end = HEIGHT - BOTTOM, WIDTH - LEFT
    middle = float(np.sqrt(low * high)) if logarithmic else 0.5 * (low + high)
    ticks = "".join(
        f'<text x="{x}" y="{HEIGHT - 5}" text-anchor="{anchor}">{value:.3g}</text>'
        for x, anchor, value in (
            (LEFT, "start", low), (WIDTH / 2, "middle", middle), (end, "end", high)
        )
    )  # fmt: skip
    return (
        f'<svg class="histogram" viewBox="0 0 {WIDTH} {HEIGHT}" role="img" '
        f'aria-label="{escape(title)}, {len(values):,} values">'
        f'<text class="title" x="{LEFT}" y="11">{escape(title)}</text>'
        f'<g fill="{FILL}">{"".join(bars)}</g>'
        f'<path d="M{LEFT} {base}H{end}" stroke="#c3c9cf"/>{ticks}</svg>'
    )
