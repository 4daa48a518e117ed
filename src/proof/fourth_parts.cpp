#include "proof/fourth_parts.hpp"

#include <algorithm>
#include <cmath>

namespace surfmesh {
namespace {

constexpr double FOURTH_ROUNDING = 0x1p-46;  // relative, more than that of any short sum here

/// Absolute values of r'', r''' and r'''' along vectors of the (u, v) plane, none of them negative.
class HighSizes {
  public:
    explicit HighSizes(const HighMagnitudes& most) : most_(most) {}

    [[nodiscard]] Point3 second(Point2 a, Point2 b) const {
        return sum(0, std::array{a.x * b.x, a.x * b.y + a.y * b.x, a.y * b.y});
    }
    [[nodiscard]] Point3 third(Point2 a, Point2 b, Point2 c) const {
        const double uu = a.x * b.x, uv = a.x * b.y + a.y * b.x, vv = a.y * b.y;
        return sum(3, std::array{uu * c.x, uu * c.y + uv * c.x, uv * c.y + vv * c.x, vv * c.y});
    }
    /// Along a twice and b twice.
    [[nodiscard]] Point3 fourth(Point2 a, Point2 b) const {
        const double uu = a.x * a.x, uv = 2.0 * a.x * a.y, vv = a.y * a.y;
        const double xx = b.x * b.x, xy = 2.0 * b.x * b.y, yy = b.y * b.y;
        return sum(7, std::array{uu * xx, uu * xy + uv * xx, uu * yy + uv * xy + vv * xx,
                                 uv * yy + vv * xy, vv * yy});
    }

  private:
    template <std::size_t N>
    [[nodiscard]] Point3 sum(std::size_t first, const std::array<double, N>& weight) const {
        Point3 size{0.0, 0.0, 0.0};
        for (std::size_t n = 0; n < N; ++n)
            if (weight[n] > 0.0) size = size + weight[n] * most_[first + n];
        return size;
    }

    const HighMagnitudes& most_;
};

/// By coordinate.
Point2 sizes_of_vector(Point2 a) { return {std::abs(a.x), std::abs(a.y)}; }

/// Bounds of |R''''(e_k, e_k, e_l, e_l)|.
Point3 fourth_along(const HighSizes& size, const PlanePiece& piece,
                    const std::array<Point2, 3>& along, std::size_t k, std::size_t l) {
    const Point2 a = along[k], b = along[l];
    Point3 found = size.fourth(a, b);
    if (piece.is_straight()) return found;
    const Point2 aa = sizes_of_vector(piece.second(k, k)), bb = sizes_of_vector(piece.second(l, l)),
                 ab = sizes_of_vector(piece.second(k, l));
    found = found + size.third(a, a, bb) + size.third(b, b, aa) + 4.0 * size.third(a, b, ab);
    return found + size.second(aa, bb) + 2.0 * size.second(ab, ab);
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
    if (!piece.is_straight())  // which may cancel
        for (Point2& e : along)
            for (const Point2 bend : piece.bend)
                e = BENDS_ROUNDING * e + 0x1p-40 * sizes_of_vector(bend);
    const HighSizes sizes(most);
    FourthParts found{};
    for (std::size_t k = 0; k < 3; ++k)
        for (std::size_t l = k; l < 3; ++l) {
            const Point3 size = fourth_along(sizes, piece, along, k, l);
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
