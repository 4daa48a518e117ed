"""Evaluation of the monotone cubic that bends one axis of the scaled plane."""

from surfmesh.kernels.jit import kernel


@kernel
def bend(x, extent, knots, slopes, parameter, rate):
    """Cubic Hermite interpolation on even knots, linear outside [0, extent].

    x (n,) scaled coordinates; knots and slopes (k,) the parameter and its derivative at k even
    coordinates from 0 to extent. Fills parameter (n,) and rate (n,), its derivative by x.
    """
    cells = len(knots) - 1
    step = extent / cells
    for k in range(len(x)):
        inside = min(max(x[k], 0.0), extent)
        i = min(int(inside / step), cells - 1)
        t = inside / step - i
        m, n = step * slopes[i], step * slopes[i + 1]
        d = knots[i + 1] - knots[i]
        b, c = 3.0 * d - 2.0 * m - n, m + n - 2.0 * d
        rate[k] = (m + t * (2.0 * b + 3.0 * t * c)) / step
        parameter[k] = knots[i] + t * (m + t * (b + t * c)) + (x[k] - inside) * rate[k]
