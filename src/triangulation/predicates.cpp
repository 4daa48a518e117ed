#include "triangulation/predicates.hpp"

#include <array>
#include <limits>

#include "triangulation/exact_sums.hpp"

namespace surfmesh {
namespace {

// products of two numbers between them have exact errors
constexpr double SMALL = 0x1p-450, LARGE = 0x1p500;

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

/// Sign-exact sum. Sweeps of error-free additions carry the sum to the last term. At the fixed
/// point each term is negligible beside the next, so the last one has the sign of the sum.
double orient_exact(Point2 a, Point2 b, Point2 c) {
    Terms t = products(a, b, c);
    for (int sweep = 0; sweep < 64; ++sweep) {
        const Terms old = t;
        double sum = t[0];
        for (std::size_t k = 1; k < t.size(); ++k) {
            const RoundedNumber s = two_sum(sum, t[k]);
            sum = s.high;
            t[k - 1] = s.low;
        }
        t.back() = sum;
        if (old == t) break;
    }
    return t.back();
}

bool is_ordinary(double x) { return x == 0.0 || (SMALL < std::abs(x) && std::abs(x) < LARGE); }

/// As ``orient_exact``, on mantissas; nan where a coordinate is not finite.
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
    return ordinary ? orient_exact(a, b, c) : orient_of_any_size(a, b, c);
}

std::int64_t first_not_ccw(std::span<const Point2> xy, std::span<const std::int64_t> triangles) {
    for (std::size_t k = 0; 3 * k < triangles.size(); ++k) {
        const std::int64_t* t = &triangles[3 * k];
        if (orient(xy[t[0]], xy[t[1]], xy[t[2]]) <= 0.0) return static_cast<std::int64_t>(k);
    }
    return NIL;
}

}  // namespace surfmesh
