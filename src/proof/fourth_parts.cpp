#include "proof/fourth_parts.hpp"

#include <algorithm>
#include <cmath>

namespace surfmesh {
namespace {

constexpr double FOURTH_ROUNDING = 0x1p-46;  // relative, more than that of any short sum here

/// By coordinate.
Point2 sizes_of_vector(Point2 a) { return {std::abs(a.x), std::abs(a.y)}; }

/// What derivatives of r from the second to the fourth order are multiplied by; none is negative.
struct HighWeights {
    std::array<double, HIGH_DERIVATIVES> of{};

    void add_second(double factor, Point2 a, Point2 b) {
        of[0] += factor * (a.x * b.x);
        of[1] += factor * (a.x * b.y + a.y * b.x);
        of[2] += factor * (a.y * b.y);
    }
    void add_third(double factor, Point2 a, Point2 b, Point2 c) {
        const double uu = factor * (a.x * b.x), uv = factor * (a.x * b.y + a.y * b.x),
                     vv = factor * (a.y * b.y);
        of[3] += uu * c.x;
        of[4] += uu * c.y + uv * c.x;
        of[5] += uv * c.y + vv * c.x;
        of[6] += vv * c.y;
    }
    /// Along a twice and b twice.
    void add_fourth(Point2 a, Point2 b) {
        const double uu = a.x * a.x, uv = 2.0 * a.x * a.y, vv = a.y * a.y;
        const double xx = b.x * b.x, xy = 2.0 * b.x * b.y, yy = b.y * b.y;
        of[7] += uu * xx;
        of[8] += uu * xy + uv * xx;
        of[9] += uu * yy + uv * xy + vv * xx;
        of[10] += uv * yy + vv * xy;
        of[11] += vv * yy;
    }
    [[nodiscard]] Point3 times(const HighMagnitudes& most) const {
        Point3 size{0.0, 0.0, 0.0};
        for (std::size_t n = 0; n < HIGH_DERIVATIVES; ++n) size = size + of[n] * most[n];
        return size;
    }
};

/// Bounds of |R''''(e_k, e_k, e_l, e_l)|.
Point3 fourth_along(const HighMagnitudes& most, const PlanePiece& piece, bool is_straight,
                    const std::array<Point2, 3>& along, std::size_t k, std::size_t l) {
    const Point2 a = along[k], b = along[l];
    HighWeights weights;
    weights.add_fourth(a, b);
    if (is_straight) return weights.times(most);
    const Point2 aa = sizes_of_vector(piece.second(k, k)), bb = sizes_of_vector(piece.second(l, l)),
                 ab = sizes_of_vector(piece.second(k, l));
    weights.add_third(1.0, a, a, bb);
    weights.add_third(1.0, b, b, aa);
    weights.add_third(4.0, a, b, ab);
    weights.add_second(1.0, aa, bb);
    weights.add_second(2.0, ab, ab);
    return weights.times(most);
}

}  // namespace

FourthParts fourth_parts(const HighMagnitudes& most, const PlanePiece& piece,
                         const Directions& axes) {
    constexpr double BENDS_ROUNDING = 1.0 + 0x1p-40;
    std::array<Point2, 3> along{};  // the largest derivatives of psi, by coordinate
    for (std::size_t k = 0; k < 3; ++k)
        for (const Barycentric& corner : AT_CORNERS) {
            const Point2 e = sizes_of_vector(piece.along(k, corner));
            along[k] = {std::max(along[k].x, e.x), std::max(along[k].y, e.y)};
        }
    const bool is_straight = piece.is_straight();
    if (!is_straight)  // which may cancel
        for (Point2& e : along)
            for (const Point2 bend : piece.bend)
                e = BENDS_ROUNDING * e + 0x1p-40 * sizes_of_vector(bend);
    FourthParts found{};
    for (std::size_t k = 0; k < 3; ++k)
        for (std::size_t l = k; l < 3; ++l) {
            const Point3 size = fourth_along(most, piece, is_straight, along, k, l);
            if (!(size.x + size.y + size.z < intervals::INFINITE)) return UNKNOWN_PARTS;
            for (std::size_t axis = 0; axis < 3; ++axis) {
                const Point3& x = axes[axis];
                const double part =
                    (std::abs(x.x) * size.x + std::abs(x.y) * size.y + std::abs(x.z) * size.z) *
                    ((1.0 + FOURTH_ROUNDING) / 6.0);
                found[axis][k] = std::max(found[axis][k], part);
                found[axis][l] = std::max(found[axis][l], part);
            }
        }
    return found;
}

}  // namespace surfmesh
