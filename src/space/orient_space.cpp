#include "space/orient_space.hpp"

#include <array>
#include <cmath>
#include <limits>
#include <span>

#include "triangulation/exact_sums.hpp"
#include "triangulation/predicates.hpp"

namespace surfmesh {
namespace {

constexpr double FILTER = (7.0 + 56.0 * EPSILON) * EPSILON;  // Shewchuk's o3derrboundA
constexpr std::size_t TERMS = 96;                            // of the sum
// products of three numbers between them have exact errors
constexpr double SMALL = 0x1p-300, LARGE = 0x1p330;

using Coordinates = std::array<double, 3>;
constexpr Coordinates coordinates(Point3 p) { return {p.x, p.y, p.z}; }

/// A sum of numbers that do not overlap, the largest last; it never has more than TERMS.
class Expansion {
  public:
    /// Add a b c, which is a sum of four numbers.
    void add_product(double a, double b, double c) {
        const RoundedNumber ab = two_product(a, b);
        const RoundedNumber upper = two_product(ab.high, c), lower = two_product(ab.low, c);
        for (const double term : {upper.low, upper.high, lower.low, lower.high}) grow(term);
    }
    [[nodiscard]] double largest() const { return length_ > 0 ? numbers_[length_ - 1] : 0.0; }

  private:
    /// Shewchuk's Grow-Expansion; zeros are left out.
    void grow(double term) {
        std::size_t kept = 0;
        for (std::size_t i = 0; i < length_; ++i) {
            const RoundedNumber sum = two_sum(term, numbers_[i]);
            term = sum.high;
            if (sum.low != 0.0) numbers_[kept++] = sum.low;
        }
        if (term != 0.0) numbers_[kept++] = term;
        length_ = kept;
    }

    std::array<double, TERMS> numbers_;
    std::size_t length_ = 0;
};

/// Add sign times the determinant of three points.
void add_determinant(Expansion& sum, double sign, Point3 a, Point3 b, Point3 c) {
    const Coordinates p = coordinates(a), q = coordinates(b), r = coordinates(c);
    for (std::size_t i = 0; i < 3; ++i) {
        const std::size_t j = (i + 1) % 3, k = (i + 2) % 3;
        sum.add_product(sign * p[i], q[j], r[k]);
        sum.add_product(-sign * p[i], q[k], r[j]);
    }
}

double orient_exact(Point3 a, Point3 b, Point3 c, Point3 d) {
    Expansion sum;
    add_determinant(sum, 1.0, a, b, c);
    add_determinant(sum, -1.0, d, b, c);
    add_determinant(sum, -1.0, a, d, c);
    add_determinant(sum, -1.0, a, b, d);
    return sum.largest();
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

double orient_without_filter(Point3 a, Point3 b, Point3 c, Point3 d) {
    const bool ordinary = is_ordinary(a) && is_ordinary(b) && is_ordinary(c) && is_ordinary(d);
    return ordinary ? orient_exact(a, b, c, d) : orient_of_any_size(a, b, c, d);
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
    return orient_without_filter(a, b, c, d);
}

}  // namespace surfmesh
