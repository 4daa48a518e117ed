#include "space/orient_space.hpp"

#include <array>
#include <cmath>
#include <limits>
#include <span>

#include "triangulation/exact_sums.hpp"
#include "triangulation/expansion.hpp"
#include "triangulation/predicates.hpp"

namespace surfmesh {
namespace {

constexpr double FILTER = (7.0 + 56.0 * EPSILON) * EPSILON;               // Shewchuk's o3derrboundA
constexpr double B_BOUND = (3.0 + 28.0 * EPSILON) * EPSILON;              // his o3derrboundB
constexpr double C_BOUND = (26.0 + 288.0 * EPSILON) * EPSILON * EPSILON;  // his o3derrboundC
constexpr std::size_t TERMS = 96;  // of the sum of all products
// products of three numbers between them have exact errors
constexpr double SMALL = 0x1p-300, LARGE = 0x1p330;

using Coordinates = std::array<double, 3>;
constexpr Coordinates coordinates(Point3 p) { return {p.x, p.y, p.z}; }

/// Add sign times the determinant of three points.
void add_determinant(Expansion<TERMS>& sum, double sign, Point3 a, Point3 b, Point3 c) {
    const Coordinates p = coordinates(a), q = coordinates(b), r = coordinates(c);
    for (std::size_t i = 0; i < 3; ++i) {
        const std::size_t j = (i + 1) % 3, k = (i + 2) % 3;
        sum.add_product(sign * p[i], q[j], r[k]);
        sum.add_product(-sign * p[i], q[k], r[j]);
    }
}

double orient_exact(Point3 a, Point3 b, Point3 c, Point3 d) {
    Expansion<TERMS> sum;
    add_determinant(sum, 1.0, a, b, c);
    add_determinant(sum, -1.0, d, b, c);
    add_determinant(sum, -1.0, a, d, c);
    add_determinant(sum, -1.0, a, b, d);
    return sum.estimate();
}

/// The difference of two points and its rounding errors.
struct Difference {
    Point3 high, low;
};

Difference difference(Point3 a, Point3 b) {
    const RoundedNumber x = two_sum(a.x, -b.x), y = two_sum(a.y, -b.y), z = two_sum(a.z, -b.z);
    return {{x.high, y.high, z.high}, {x.low, y.low, z.low}};
}

bool is_zero(Point3 p) { return p.x == 0.0 && p.y == 0.0 && p.z == 0.0; }

/// p.z (q.x r.y - q.y r.x) without error.
void add_minor(Expansion<24>& sum, Point3 p, Point3 q, Point3 r) {
    sum.add_product(q.x, r.y, p.z);
    sum.add_product(-q.y, r.x, p.z);
}

/// What the rounding errors of the differences add to p.z (q.x r.y - q.y r.x), in first order.
double minor_change(const Difference& p, const Difference& q, const Difference& r) {
    return p.high.z * ((q.high.x * r.low.y + r.high.y * q.low.x) -
                       (q.high.y * r.low.x + r.high.x * q.low.y)) +
           p.low.z * (q.high.x * r.high.y - q.high.y * r.high.x);
}

/// Stages B to D of Shewchuk's adaptive orientation, as in the plane (predicates.cpp).
double orient_in_stages(Point3 a, Point3 b, Point3 c, Point3 d, double permanent) {
    const Difference p = difference(a, d), q = difference(b, d), r = difference(c, d);
    Expansion<24> sum;
    add_minor(sum, p.high, q.high, r.high);
    add_minor(sum, q.high, r.high, p.high);
    add_minor(sum, r.high, p.high, q.high);
    double det = sum.estimate();
    if (std::abs(det) >= B_BOUND * permanent) return det;
    if (is_zero(p.low) && is_zero(q.low) && is_zero(r.low)) return det;
    const double bound = C_BOUND * permanent + RESULT_BOUND * std::abs(det);
    det += minor_change(p, q, r) + minor_change(q, r, p) + minor_change(r, p, q);
    return std::abs(det) >= bound ? det : orient_exact(a, b, c, d);
}

bool is_ordinary(double x) { return x == 0.0 || (SMALL < std::abs(x) && std::abs(x) < LARGE); }
bool is_ordinary(Point3 p) { return is_ordinary(p.x) && is_ordinary(p.y) && is_ordinary(p.z); }
bool is_finite(Point3 p) { return std::isfinite(p.x) && std::isfinite(p.y) && std::isfinite(p.z); }

/// Put a b c as four terms with their exponents.
void put_product(std::span<ScaledNumber, 4> terms, double a, double b, double c) {
    int i, j, k;
    a = std::frexp(a, &i);
    b = std::frexp(b, &j);
    c = std::frexp(c, &k);
    const RoundedNumber ab = two_product(a, b);
    const RoundedNumber upper = two_product(ab.high, c), lower = two_product(ab.low, c);
    const double mantissas[] = {upper.high, upper.low, lower.high, lower.low};
    for (std::size_t n = 0; n < 4; ++n) terms[n] = {mantissas[n], i + j + k};
}

/// As ``orient_exact``, on mantissas; nan where a coordinate is not finite.
double orient_of_any_size(Point3 a, Point3 b, Point3 c, Point3 d) {
    if (!(is_finite(a) && is_finite(b) && is_finite(c) && is_finite(d)))
        return std::numeric_limits<double>::quiet_NaN();
    struct Determinant {
        double sign;
        Point3 a, b, c;
    };
    std::array<ScaledNumber, TERMS> terms;
    std::size_t count = 0;
    const auto put = [&](double x, double y, double z) {
        put_product(std::span<ScaledNumber, 4>(&terms[count], 4), x, y, z);
        count += 4;
    };
    for (const Determinant& of :
         {Determinant{1.0, a, b, c}, {-1.0, d, b, c}, {-1.0, a, d, c}, {-1.0, a, b, d}}) {
        const Coordinates p = coordinates(of.a), q = coordinates(of.b), r = coordinates(of.c);
        for (std::size_t i = 0; i < 3; ++i) {
            const std::size_t j = (i + 1) % 3, k = (i + 2) % 3;
            put(of.sign * p[i], q[j], r[k]);
            put(-of.sign * p[i], q[k], r[j]);
        }
    }
    return exact_sum(terms);
}

double orient_without_filter(Point3 a, Point3 b, Point3 c, Point3 d, double permanent) {
    const bool ordinary = is_ordinary(a) && is_ordinary(b) && is_ordinary(c) && is_ordinary(d);
    return ordinary ? orient_in_stages(a, b, c, d, permanent) : orient_of_any_size(a, b, c, d);
}

}  // namespace

double orient_space(Point3 a, Point3 b, Point3 c, Point3 d) {
    const Point3 p = a - d, q = b - d, r = c - d;
    const double bc = q.x * r.y, cb = r.x * q.y;
    const double ca = r.x * p.y, ac = p.x * r.y;
    const double ab = p.x * q.y, ba = q.x * p.y;
    const double det = p.z * (bc - cb) + q.z * (ca - ac) + r.z * (ab - ba);
    const double permanent = (std::abs(bc) + std::abs(cb) + UNDERFLOW_BOUND) * std::abs(p.z) +
                             (std::abs(ca) + std::abs(ac) + UNDERFLOW_BOUND) * std::abs(q.z) +
                             (std::abs(ab) + std::abs(ba) + UNDERFLOW_BOUND) * std::abs(r.z);
    if (std::abs(det) > FILTER * permanent + UNDERFLOW_BOUND) return det;
    if ((p.x == 0.0 && q.x == 0.0 && r.x == 0.0) || (p.y == 0.0 && q.y == 0.0 && r.y == 0.0) ||
        (p.z == 0.0 && q.z == 0.0 && r.z == 0.0))
        return 0.0;  // on a plane across an axis: common, and a difference of zero is exact
    return orient_without_filter(a, b, c, d, permanent);
}

}  // namespace surfmesh
