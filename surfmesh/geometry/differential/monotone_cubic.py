"""A cubic spline that rises wherever its points do, once differentiable.

Slopes are weighted harmonic means of those of the two steps beside a point, zero where these
differ in sign (Fritsch and Butland, SIAM J. Sci. Stat. Comput. 5, 1984, 300-304); at an end a
parabola through three points gives the slope, held back where it would overshoot (Moler,
Numerical Computing with Matlab, section 3.6).

    y_k -- h_k, m_k -- y_k+1       m: slope of the straight step, d: slope of the spline
    d_k           d_k+1

The same as SciPy's ``PchipInterpolator``, to the last bit, without the import of
``scipy.interpolate``, which takes longer than a small mesh.
"""

import numpy as np


class MonotoneCubic:
    """Through points y (n,) at rising x (n,), n >= 2."""

    def __init__(self, x: np.ndarray, y: np.ndarray) -> None:
        step = np.diff(x)
        slope = np.diff(y) / step
        at_points = _slopes(step, slope)
        bend = (at_points[:-1] + at_points[1:] - 2 * slope) / step
        self.x = x
        self.coefficients = np.stack(  # of 1, w, w^2, w^3 in the distance w from the left end
            [y[:-1], at_points[:-1], (slope - at_points[:-1]) / step - bend, bend / step]
        )

    def __call__(self, x: np.ndarray) -> np.ndarray:
        """Values (m,) at x (m,); beyond the ends the outermost cubics go on."""
        piece, way = self._place(x)
        return _polynomial(self.coefficients[:, piece], way)

    def derivative(self, x: np.ndarray) -> np.ndarray:
        """Derivatives (m,) at x (m,)."""
        piece, way = self._place(x)
        factors = np.array([1.0, 2.0, 3.0])[:, None]
        return _polynomial(self.coefficients[1:, piece] * factors, way)

    def _place(self, x: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """The piece (m,) that x (m,) lies in, the right one at a point, and the way into it."""
        piece = np.searchsorted(self.x, x, side="right") - 1
        piece = np.clip(piece, 0, len(self.x) - 2)
        return piece, x - self.x[piece]


def _polynomial(coefficients: np.ndarray, x: np.ndarray) -> np.ndarray:
    """Sum of c_k x^k, by rising powers: c (k, m), x (m,)."""
    total, power = coefficients[0], np.ones_like(x)
    for coefficient in coefficients[1:]:
        power = power * x
        total = total + coefficient * power
    return total


def _slopes(step: np.ndarray, slope: np.ndarray) -> np.ndarray:
    """Slopes (n,) of the spline at its points, from the lengths and slopes (n - 1,) of steps."""
    if len(step) == 1:
        return np.repeat(slope, 2)
    before, after = step[:-1], step[1:]
    first, second = 2 * after + before, after + 2 * before
    left, right = slope[:-1], slope[1:]
    turns = (np.sign(left) != np.sign(right)) | (left == 0.0) | (right == 0.0)
    with np.errstate(divide="ignore", invalid="ignore"):
        mean = (first / left + second / right) / (first + second)
        inner = np.where(turns, 0.0, 1.0 / mean)
    ends = [_end_slope(*step[:2], *slope[:2]), _end_slope(*step[:-3:-1], *slope[:-3:-1])]
    return np.concatenate([ends[:1], inner, ends[1:]])


def _end_slope(h0: float, h1: float, m0: float, m1: float) -> float:
    """From the lengths and slopes of the step at the end and of the next one."""
    parabola = ((2 * h0 + h1) * m0 - h0 * m1) / (h0 + h1)
    if np.sign(parabola) != np.sign(m0):
        return 0.0
    if np.sign(m0) != np.sign(m1) and abs(parabola) > 3.0 * abs(m0):
        return 3.0 * m0
    return parabola
