#include "triangulation/predicates.hpp"

#include <array>
#include <limits>

#include "triangulation/exact_sums.hpp"
#include "triangulation/expansion.hpp"

namespace surfmesh {
namespace {

// products of two numbers between them have exact errors
constexpr double SMALL = 0x1p-450, LARGE = 0x1p500;

/// Stages B to D of Shewchuk's adaptive orientation: each is exact for more triples, and costs more.
///
/// The differences of the coordinates are kept with their rounding errors, ``low``.
double orient_in_stages(Point2 a, Point2 b, Point2 c) {
    constexpr double B = (2.0 + 12.0 * EPSILON) * EPSILON;            // his ccwerrboundB
    constexpr double C = (9.0 + 64.0 * EPSILON) * EPSILON * EPSILON;  // his ccwerrboundC
    const RoundedNumber ax = two_sum(a.x, -c.x), ay = two_sum(a.y, -c.y);
    const RoundedNumber bx = two_sum(b.x, -c.x), by = two_sum(b.y, -c.y);
    const double magnitude = std::abs(ax.high * by.high) + std::abs(ay.high * bx.high);

    Expansion<16> sum;  // B: the determinant of the rounded differences, without error
    sum.add_product(ax.high, by.high);
    sum.add_product(-ay.high, bx.high);
    double det = sum.estimate();
    if (std::abs(det) >= B * magnitude) return det;
    if (ax.low == 0.0 && ay.low == 0.0 && bx.low == 0.0 && by.low == 0.0) return det;

    const double bound = C * magnitude + RESULT_BOUND * std::abs(det);  // C: errors, rounded
    det += (ax.high * by.low + by.high * ax.low) - (ay.high * bx.low + bx.high * ay.low);
    if (std::abs(det) >= bound) return det;

    sum.add_product(ax.low, by.low);  // D: all without error
    sum.add_product(-ay.low, bx.low);
    sum.add_product(ax.low, by.high);
    sum.add_product(-ay.low, bx.high);
    sum.add_product(ax.high, by.low);
    sum.add_product(-ay.high, bx.low);
    return sum.estimate();
}

bool is_ordinary(double x) { return x == 0.0 || (SMALL < std::abs(x) && std::abs(x) < LARGE); }

using Terms = std::array<double, 12>;

/// ax by - ay bx + bx cy - by cx + cx ay - cy ax without error, a sum of twelve terms.
Terms products(Point2 a, Point2 b, Point2 c) {
    const RoundedNumber p[] = {two_product(a.x, b.y), two_product(-a.y, b.x),
                               two_product(b.x, c.y), two_product(-b.y, c.x),
                               two_product(c.x, a.y), two_product(-c.y, a.x)};
    Terms terms;
    for (std::size_t k = 0; k < 6; ++k) {
        terms[2 * k] = p[k].low;
        terms[2 * k + 1] = p[k].high;
    }
    return terms;
}

/// As ``orient_in_stages``, on mantissas and exponents; nan where a coordinate is not finite.
double orient_of_any_size(Point2 a, Point2 b, Point2 c) {
    double m[6] = {a.x, a.y, b.x, b.y, c.x, c.y};
    int e[6];
    for (int k = 0; k < 6; ++k) {
        if (!std::isfinite(m[k])) return std::numeric_limits<double>::quiet_NaN();
        m[k] = std::frexp(m[k], &e[k]);
    }
    const Terms t = products({m[0], m[1]}, {m[2], m[3]}, {m[4], m[5]});
    const int exponents[6] = {e[0] + e[3], e[1] + e[2], e[2] + e[5],
                              e[3] + e[4], e[4] + e[1], e[5] + e[0]};
    std::array<ScaledNumber, 12> terms;
    for (std::size_t k = 0; k < terms.size(); ++k) terms[k] = {t[k], exponents[k / 2]};
    return exact_sum(terms);
}

}  // namespace

double orient_without_filter(Point2 a, Point2 b, Point2 c) {
    const bool ordinary = is_ordinary(a.x) && is_ordinary(a.y) && is_ordinary(b.x) &&
                          is_ordinary(b.y) && is_ordinary(c.x) && is_ordinary(c.y);
    return ordinary ? orient_in_stages(a, b, c) : orient_of_any_size(a, b, c);
}

std::int64_t first_not_ccw(std::span<const Point2> xy, std::span<const std::int64_t> triangles) {
    for (std::size_t k = 0; 3 * k < triangles.size(); ++k) {
        const std::int64_t* t = &triangles[3 * k];
        if (orient(xy[t[0]], xy[t[1]], xy[t[2]]) <= 0.0) return static_cast<std::int64_t>(k);
    }
    return NIL;
}

}  // namespace surfmesh
