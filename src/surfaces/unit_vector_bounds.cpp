#include "surfaces/unit_vector_bounds.hpp"

#include <cmath>

namespace surfmesh {
namespace {

using outward::add, outward::subtract, outward::multiply, outward::exactly;

constexpr Interval ZERO_TO_ONE{0.0, 1.0};

Interval square_of(Interval x) { return outward::rounded(intervals::integer_power(x, 2)); }

/// N / |N| by its slopes p = N_x / N_z and q = N_y / N_z, where N_z is positive: (p, q, 1) over the
/// root of 1 + p^2 + q^2.
BoxedVector normal_by_slopes(const BoxedVector& N) {
    const Interval per_z = outward::reciprocal(N.z);
    const Interval p = multiply(N.x, per_z), q = multiply(N.y, per_z);
    const Interval whole = add(exactly(1.0), add(square_of(p), square_of(q)));
    const Interval root = outward::rounded(intervals::sqrt(whole));
    const Interval z = outward::common(outward::reciprocal(root), ZERO_TO_ONE);
    return {multiply(p, z), multiply(q, z), z};
}

}  // namespace

Directions frame_at(Point3 a, Point3 b) {
    const Point3 N = cross(a, b);
    const double wide = norm(a), high = norm(N);
    if (!(wide > 0.0) || !(high > 0.0)) return AXES;
    const Point3 x = (1.0 / wide) * a, n = (1.0 / high) * N;
    const Point3 y = cross(n, x);
    // a x b of vectors that hardly differ may be anything
    const bool is_right_angled = std::abs(dot(n, x)) < 0x1p-46;
    return is_right_angled ? Directions{x, y, n} : AXES;
}

Directions in_frame(const Directions& frame, const Directions& directions) {
    Directions found{};
    for (std::size_t k = 0; k < 3; ++k) {
        const Point3& d = directions[k];
        found[k] = {dot(frame[0], d), dot(frame[1], d), dot(frame[2], d)};
    }
    return found;
}

BoxedVector across(const BoxedVector& a, const BoxedVector& n, Interval per_length) {
    const Interval x = square_of(n.x), y = square_of(n.y), z = square_of(n.z);
    const Interval along_x = multiply(a.x, n.x), along_y = multiply(a.y, n.y),
                   along_z = multiply(a.z, n.z);
    const auto left = [](Interval own, Interval fraction, Interval n_own, Interval others) {
        return subtract(multiply(own, outward::common(fraction, ZERO_TO_ONE)),
                        multiply(n_own, others));
    };
    return multiply(per_length, {left(a.x, add(y, z), n.x, add(along_y, along_z)),
                                 left(a.y, add(z, x), n.y, add(along_z, along_x)),
                                 left(a.z, add(x, y), n.z, add(along_x, along_y))});
}

bool bound_unit_vector(const BoxedVector& N, UnitVector& out) {
    const Interval length = outward::length(N);
    if (!(length.lo > 0.0) || !(length.hi < intervals::INFINITE)) return false;
    out.per_length = outward::reciprocal(length);
    constexpr Interval UNIT{-1.0, 1.0};
    const BoxedVector n = N.z.lo > 0.0 ? normal_by_slopes(N) : multiply(out.per_length, N);
    out.n = {outward::common(n.x, UNIT), outward::common(n.y, UNIT), outward::common(n.z, UNIT)};
    return true;
}

BoxedVector UnitVector::first(const BoxedVector& N_i) const { return across(N_i, n, per_length); }

BoxedVector UnitVector::second(const BoxedVector& N_ij, const FirstOfVector& i,
                               const FirstOfVector& j) const {
    const BoxedVector rest =
        add(add(multiply(outward::dot(n, i.N), j.n), multiply(outward::dot(n, j.N), i.n)),
            multiply(outward::dot(j.n, i.N), n));
    return subtract(across(N_ij, n, per_length), multiply(per_length, rest));
}

SplitDirection::SplitDirection(const Point3& direction, const BoxedVector& n) : d(direction) {
    const Point3 middle = {0.5 * (n.x.lo + n.x.hi), 0.5 * (n.y.lo + n.y.hi),
                           0.5 * (n.z.lo + n.z.hi)};
    c = dot(direction, middle);
    t = subtract(exactly(direction), multiply(exactly(c), n));
}

Interval SplitDirection::along_second(const BoxedVector& n_ij, Interval product) const {
    const Interval split = subtract(outward::dot(t, n_ij), multiply(exactly(c), product));
    return outward::common(along(d, n_ij), split);
}

}  // namespace surfmesh
