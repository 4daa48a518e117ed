// Second derivatives of a surface over cells of (u, v), and what they say of triangles there.
//
// Around the centre c of a cell, by Taylor's formula,
//
//     r_uu(c + (s, t)) = r_uu + s r_uuu + t r_uuv + (s^2 r_uuuu + 2 s t r_uuuv + t^2 r_uuvv) / 2
//
// with the fourth derivatives somewhere in the cell; likewise r_uv and r_vv. Bounds of these alone
// depend on the cell: over every box in it the second derivatives are known more closely than by
// intervals, in which a variable that is read twice counts as two.
//
// Source: Moore, Kearfott, Cloud, "Introduction to Interval Analysis", SIAM 2009, chapters 6 and 9.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <span>

#include "surfaces/closest_point.hpp"
#include "surfaces/fourth_derivatives.hpp"
#include "values/array.hpp"

namespace surfmesh {

inline constexpr std::size_t BENDS = 3;  // r_uu, r_uv, r_vv

/// The larger of two, NaN where one of them is: then nothing is bounded.
inline double larger_or_nan(double a, double b) { return b > a || b != b ? b : a; }

inline ParameterBox box_of(const ParameterTriangle& t) {
    return {
        {std::min(std::min(t[0].x, t[1].x), t[2].x), std::min(std::min(t[0].y, t[1].y), t[2].y)},
        {std::max(std::max(t[0].x, t[1].x), t[2].x), std::max(std::max(t[0].y, t[1].y), t[2].y)}};
}

inline ParameterBox around(const ParameterBox& a, const ParameterBox& b) {
    return {{std::min(a.low.x, b.low.x), std::min(a.low.y, b.low.y)},
            {std::max(a.high.x, b.high.x), std::max(a.high.y, b.high.y)}};
}

inline Point3 sizes(Point3 p) { return {std::abs(p.x), std::abs(p.y), std::abs(p.z)}; }

/// Most of l0 l1 a + l1 l2 b + l2 l0 c for barycentric l: within the triangle, or amid an edge.
double most_between(double a, double b, double c);

/// Bounds of second derivatives over a box as their middles and half their widths: along n they
/// are n . middle, give or take |n| . half.
struct MiddleBends {
    std::array<Point3, BENDS> middle, half;

    /// Of bounds from below and above.
    static MiddleBends between(const Point3* lower, const Point3* upper);

    /// Does linear interpolation over a triangle within the box err by so much at most along n, times
    /// its length? Not where a bound is not finite.
    [[nodiscard]] bool err_within(double limit, const ParameterTriangle& uv, Point3 n) const;
    /// The same over all of a box of such a size, not a triangle alone; bounds of a coordinate in
    /// which n has no part need not be finite.
    [[nodiscard]] bool err_within(double limit, Point2 size, Point3 n) const;
};

/// Second derivatives along n, each give or take what is around it.
struct BendsAlong {
    std::array<double, BENDS> middle, half;

    BendsAlong(const MiddleBends& bends, Point3 n) {
        for (std::size_t j = 0; j < BENDS; ++j) {
            middle[j] = dot(n, bends.middle[j]);
            half[j] = dot(sizes(n), bends.half[j]);
        }
    }
    /// The largest of the second derivative along d.
    [[nodiscard]] double most(Point2 d) const {
        const double uu = d.x * d.x, twice = 2.0 * d.x * d.y, vv = d.y * d.y;
        return std::abs(uu * middle[0] + twice * middle[1] + vv * middle[2]) +
               (uu * half[0] + std::abs(twice) * half[1] + vv * half[2]);
    }
};

inline MiddleBends MiddleBends::between(const Point3* lower, const Point3* upper) {
    MiddleBends found;
    for (std::size_t j = 0; j < BENDS; ++j) {
        found.middle[j] = 0.5 * (lower[j] + upper[j]);
        found.half[j] = 0.5 * (upper[j] - lower[j]);
    }
    return found;
}

inline bool MiddleBends::err_within(double limit, const ParameterTriangle& uv, Point3 n) const {
    const BendsAlong bends(*this, n);
    const double a = bends.most(uv[1] - uv[0]), b = bends.most(uv[2] - uv[1]),
                 c = bends.most(uv[0] - uv[2]);
    const double all = a + b + c;
    if (all != all) return false;
    return std::max(a, std::max(b, c)) <= 6.0 * limit || 0.5 * most_between(a, b, c) <= limit;
}

inline bool MiddleBends::err_within(double limit, Point2 size, Point3 n) const {
    const auto times = [](double a, double b) { return a == 0.0 ? 0.0 : a * b; };
    const auto most = [&](std::size_t j) {
        const Point3 &m = middle[j], &h = half[j], by = sizes(n);
        return std::abs(times(n.x, m.x) + times(n.y, m.y) + times(n.z, m.z)) +
               (times(by.x, h.x) + times(by.y, h.y) + times(by.z, h.z));
    };
    return size.x * size.x * most(0) + 2.0 * size.x * size.y * most(1) +
               size.y * size.y * most(2) <=
           8.0 * limit;
}

/// The second derivatives over a cell by Taylor's formula.
class BendModel {
  public:
    BendModel() = default;
    /// there: derivatives at the centre; over: over all of the cell.
    BendModel(Point2 centre, const HighDerivatives& there, const HighDerivatives& over);

    /// Their bounds over a box within the cell.
    [[nodiscard]] MiddleBends over(const ParameterBox& box) const;
    /// Are all of its numbers finite?
    [[nodiscard]] bool is_known() const { return known_; }

  private:
    Point2 centre_;
    std::array<Point3, BENDS> second_, second_off_;  // and what they are off by at most
    std::array<Point3, 4> third_, third_off_;
    std::array<Point3, 5> fourth_, fourth_off_;  // half of them
    bool known_ = false;
};

/// Those of cells into models.
SurfaceStatus bend_models(const FourthDerivatives& surface, std::span<const ParameterBox> cells,
                          Array<BendModel>& models);

}  // namespace surfmesh
