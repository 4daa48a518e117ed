"""B-spline curves and surfaces, rational or not, with derivatives up to the third order.

Source: Piegl, Tiller, "The NURBS Book", 2nd edition, 1997: A2.2 and A2.3 (basis functions and
their derivatives), A3.2 and A3.6 (sums over control points), A4.2 and A4.4 (quotient rule).

A flat knot vector of m + 1 numbers and n + 1 control points fix the degree p = m - n - 1; the
parameter runs from knots[p] to knots[n + 1], whether the ends are clamped or not:

     knots   | 0 .. p-1 |  p   ...   n+1  | n+2 .. m |
                           first     last
     span s: knots[s] <= t < knots[s+1], where N_{s-p} .. N_s are not zero

Violation the ends the polynomial of the end span goes on; where there is a period, t is brought
back by whole periods. The rational ones have control points (x, y, z, w), w the weight.

Sums run over the distances from a control point in the middle of the span, which is added in
the end: derivatives keep their digits far from the origin, where they would else be small
differences of large coordinates.

Derivatives of a surface come in the order r, u, v, uu, uv, vv, uuu, uuv, uvv, vvv: the one
with k times d/du and l times d/dv has the number (k + l)(k + l + 1)/2 + l.
"""

import math

from surfmesh.kernels.jit import kernel

SNAP = 1e-12  # of the knots' range: an end of the domain this near to a knot is that knot


@kernel
def _last_knot_not_above(knots, degree, t):
    """The span of t by bisection; beyond the ends the outermost span that is not empty."""
    lo = degree
    hi = len(knots) - degree - 2
    while lo < hi:
        middle = (lo + hi + 1) >> 1
        if knots[middle] <= t:
            lo = middle
        else:
            hi = middle - 1
    span = lo
    while span > degree and knots[span] == knots[span + 1]:
        span -= 1
    while span < len(knots) - degree - 2 and knots[span] == knots[span + 1]:
        span += 1
    return span


@kernel
def locate(knots, degree, t, first, last, period):
    """The span of t and t brought into it by whole periods.

    At a knot that is an end of [first, last], the interval in use, the span lies inside.
    period: 0 for none.
    """
    start = knots[degree]
    end = knots[len(knots) - degree - 1]
    tiny = SNAP * (end - start)
    local = t
    if period > 0.0 and (t < start or t > end):
        local = t - period * math.floor((t - start) / period)
    span = _last_knot_not_above(knots, degree, local)
    if abs(t - last) <= tiny and local - knots[span] <= tiny:
        if span > degree and knots[span] > start:
            span -= 1
            while span > degree and knots[span] == knots[span + 1]:
                span -= 1
        elif period > 0.0:
            local += period
            span = _last_knot_not_above(knots, degree, end)
    elif abs(t - first) <= tiny and knots[span + 1] - local <= tiny:
        if knots[span + 1] < end:
            span = _last_knot_not_above(knots, degree, knots[span + 1])
        elif period > 0.0:
            local -= period
            span = _last_knot_not_above(knots, degree, start)
    return span, local


@kernel
def basis_derivatives(knots, degree, span, t, order, table, out):
    """The functions that are not zero in a span, and their derivatives: out (order + 1, p + 1).

    table (p + 1, p + 1) is scratch: above the diagonal table[r, j] = N_{span-j+r} of degree j,
    below it table[j, r] = the knots' distance that the function of degree j is divided by. No
    such distance is less than the span, which is not empty.
    """
    table[0, 0] = 1.0
    for j in range(1, degree + 1):
        saved = 0.0
        for r in range(j):
            low = knots[span + 1 - j + r]
            high = knots[span + r + 1]
            width = high - low
            table[j, r] = width
            part = table[r, j - 1] / width
            table[r, j] = saved + (high - t) * part
            saved = (t - low) * part
        table[j, j] = saved
    for r in range(degree + 1):
        out[0, r] = table[r, degree]
    for k in range(1, order + 1):
        if k > degree:
            for r in range(degree + 1):
                out[k, r] = 0.0
            continue
        # N'_i of degree q = q (N_i / width_i - N_{i+1} / width_{i+1}), both of degree q - 1
        for r in range(degree - k + 1):
            out[k, r] = table[r, degree - k]
        for q in range(degree - k + 1, degree + 1):
            left = 0.0
            for r in range(q):
                right = out[k, r] / table[q, r]
                out[k, r] = q * (left - right)
                left = right
            out[k, q] = q * left


@kernel
def curve_derivatives(knots, control, limits, t, order, scratch, out):
    """c, c', ... at t (n,): out (order + 1, n, d).

    control (n + 1, d), or (n + 1, d + 1) with weights. limits: first, last, period.
    scratch: at least (p + 1 + 2 (order + 1), max(p + 1, d + 1)).
    """
    degree = len(knots) - len(control) - 1
    columns = control.shape[1]
    dimension = out.shape[2]
    table = scratch[: degree + 1]
    basis = scratch[degree + 1 : degree + 2 + order]
    sums = scratch[degree + 2 + order : degree + 3 + 2 * order]
    for point in range(len(t)):
        span, local = locate(knots, degree, t[point], limits[0], limits[1], limits[2])
        basis_derivatives(knots, degree, span, local, order, table, basis)
        middle = span - degree // 2
        for k in range(order + 1):
            for c in range(columns):
                near = control[middle, c] if c < dimension else 0.0
                total = 0.0
                for a in range(degree + 1):
                    x = control[span - degree + a, c] - near
                    if c < dimension < columns:
                        x *= control[span - degree + a, dimension]
                    total += basis[k, a] * x
                sums[k, c] = total
        for c in range(dimension):
            for k in range(order + 1):
                value = sums[k, c]
                if columns > dimension:  # A4.2
                    binomial = 1.0
                    for i in range(1, k + 1):
                        binomial = binomial * (k - i + 1) / i
                        value -= binomial * sums[i, dimension] * out[k - i, point, c]
                    value /= sums[0, dimension]
                out[k, point, c] = value
            out[0, point, c] += control[middle, c]


@kernel
def _tensor_sums(control, row, column, degrees, order, basis_u, basis_v, sums):
    """Sums over the control points of one span: sums (10, columns); A3.6.

    Those of x, y and z are taken from the middle control point, and times the weights.
    """
    rational = control.shape[2] == 4
    for c in range(control.shape[2]):
        near = control[row + degrees[0] // 2, column + degrees[1] // 2, c] if c < 3 else 0.0
        for k in range((order + 1) * (order + 2) // 2):
            sums[k, c] = 0.0
        for a in range(degrees[0] + 1):
            s0 = 0.0
            s1 = 0.0
            s2 = 0.0
            s3 = 0.0
            for b in range(degrees[1] + 1):
                x = control[row + a, column + b, c] - near
                if rational and c < 3:
                    x *= control[row + a, column + b, 3]
                s0 += x * basis_v[0, b]
                if order > 0:
                    s1 += x * basis_v[1, b]
                if order > 1:
                    s2 += x * basis_v[2, b]
                if order > 2:
                    s3 += x * basis_v[3, b]
            sums[0, c] += basis_u[0, a] * s0
            if order > 0:
                sums[1, c] += basis_u[1, a] * s0
                sums[2, c] += basis_u[0, a] * s1
            if order > 1:
                sums[3, c] += basis_u[2, a] * s0
                sums[4, c] += basis_u[1, a] * s1
                sums[5, c] += basis_u[0, a] * s2
            if order > 2:
                sums[6, c] += basis_u[3, a] * s0
                sums[7, c] += basis_u[2, a] * s1
                sums[8, c] += basis_u[1, a] * s2
                sums[9, c] += basis_u[0, a] * s3


@kernel
def _quotient(sums, order, out, point):
    """Derivatives of r from those of (w x, w y, w z, w) in sums (10, 4); A4.4."""
    inverse = 1.0 / sums[0, 3]
    for total in range(order + 1):
        for l in range(total + 1):
            k = total - l
            number = total * (total + 1) // 2 + l
            for c in range(3):
                value = sums[number, c]
                outer = 1.0  # binomial coefficients k over i, and l over j
                for i in range(k + 1):
                    inner = outer
                    for j in range(l + 1):
                        if i + j > 0:
                            w = sums[(i + j) * (i + j + 1) // 2 + j, 3]
                            rest = total - i - j
                            value -= inner * w * out[rest * (rest + 1) // 2 + l - j, point, c]
                        inner = inner * (l - j) / (j + 1)
                    outer = outer * (k - i) / (i + 1)
                out[number, point, c] = value * inverse


@kernel
def surface_derivatives(knots_u, knots_v, control, limits, uv, order, scratch, out):
    """r and its partial derivatives of total order <= order <= 3 at uv (n, 2): out (m, n, 3).

    control (nu, nv, 3), or (nu, nv, 4) with weights. limits: first, last and period of u, the
    same of v. scratch: at least (p + 19, max(p + 1, 4)), p the larger of the two degrees.
    """
    degree_u = len(knots_u) - control.shape[0] - 1
    degree_v = len(knots_v) - control.shape[1] - 1
    rows = max(degree_u, degree_v) + 1
    table = scratch[:rows]
    basis_u = scratch[rows : rows + 4]
    basis_v = scratch[rows + 4 : rows + 8]
    sums = scratch[rows + 8 :]
    for point in range(len(uv)):
        row, u = locate(knots_u, degree_u, uv[point, 0], limits[0], limits[1], limits[2])
        column, v = locate(knots_v, degree_v, uv[point, 1], limits[3], limits[4], limits[5])
        basis_derivatives(knots_u, degree_u, row, u, order, table, basis_u)
        basis_derivatives(knots_v, degree_v, column, v, order, table, basis_v)
        degrees = (degree_u, degree_v)
        row -= degree_u
        column -= degree_v
        _tensor_sums(control, row, column, degrees, order, basis_u, basis_v, sums)
        if control.shape[2] == 4:
            _quotient(sums, order, out, point)
        else:
            for k in range((order + 1) * (order + 2) // 2):
                for c in range(3):
                    out[k, point, c] = sums[k, c]
        for c in range(3):
            out[0, point, c] += control[row + degree_u // 2, column + degree_v // 2, c]
