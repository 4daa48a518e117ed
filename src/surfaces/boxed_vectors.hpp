// Vectors that lie in boxes: sums and products, rounded outwards.
#pragma once

#include "surfaces/enclosure.hpp"
#include "surfaces/outward.hpp"

namespace surfmesh::outward {

inline BoxedVector add(const BoxedVector& a, const BoxedVector& b) {
    return {add(a.x, b.x), add(a.y, b.y), add(a.z, b.z)};
}
inline BoxedVector subtract(const BoxedVector& a, const BoxedVector& b) {
    return {subtract(a.x, b.x), subtract(a.y, b.y), subtract(a.z, b.z)};
}
inline BoxedVector multiply(Interval s, const BoxedVector& a) {
    return {multiply(s, a.x), multiply(s, a.y), multiply(s, a.z)};
}
inline BoxedVector hull(const BoxedVector& a, const BoxedVector& b) {
    return {hull(a.x, b.x), hull(a.y, b.y), hull(a.z, b.z)};
}
inline BoxedVector exactly(const Point3& a) { return {exactly(a.x), exactly(a.y), exactly(a.z)}; }

inline Interval dot(const BoxedVector& a, const BoxedVector& b) {
    return add(add(multiply(a.x, b.x), multiply(a.y, b.y)), multiply(a.z, b.z));
}
inline BoxedVector cross(const BoxedVector& a, const BoxedVector& b) {
    return {subtract(multiply(a.y, b.z), multiply(a.z, b.y)),
            subtract(multiply(a.z, b.x), multiply(a.x, b.z)),
            subtract(multiply(a.x, b.y), multiply(a.y, b.x))};
}
/// The sum of the largest absolute values of the coordinates.
inline double norm_1(const BoxedVector& a) {
    return magnitude(a.x) + magnitude(a.y) + magnitude(a.z);
}
inline Interval& coordinate(BoxedVector& a, std::size_t axis) {
    return axis == 0 ? a.x : axis == 1 ? a.y : a.z;
}
inline Interval coordinate(const BoxedVector& a, std::size_t axis) {
    return axis == 0 ? a.x : axis == 1 ? a.y : a.z;
}

/// d . (to - from), which is rounded by less than the margin, of its terms.
inline Interval along_between(const Point3& d, const Point3& from, const Point3& to) {
    constexpr double ROUNDED = 0x1p-48;
    const double way = surfmesh::dot(d, to - from);
    const double margin =
        ROUNDED * surfmesh::norm_1(d) * (surfmesh::norm_1(to) + surfmesh::norm_1(from));
    return {way - margin, way + margin};
}

/// a . a, which is not negative.
inline Interval square(const BoxedVector& a) {
    const auto of = [](Interval x) { return rounded(intervals::integer_power(x, 2)); };
    const Interval sum = add(add(of(a.x), of(a.y)), of(a.z));
    return {std::max(sum.lo, 0.0), sum.hi};
}
inline Interval length(const BoxedVector& a) {
    const Interval root = rounded(intervals::sqrt(square(a)));
    return {std::max(root.lo, 0.0), root.hi};
}

/// What both hold.
inline Interval common(Interval a, Interval b) {
    return {std::max(a.lo, b.lo), std::min(a.hi, b.hi)};
}

}  // namespace surfmesh::outward
