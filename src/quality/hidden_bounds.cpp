#include "quality/hidden_bounds.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace surfmesh {
namespace {

constexpr std::size_t HIDDEN_BLOCK = 1024;  // triangles looked at together
constexpr std::size_t BOUNDS = 1 + BOUNDED_DERIVATIVES;
constexpr std::size_t UU = 3;  // of the bounds of a cell: r_uu, r_uv, r_vv from there

/// The larger_or_nan of two, NaN where one of them is: then nothing is bounded.
double larger_or_nan(double a, double b) { return b > a || b != b ? b : a; }
double smaller(double a, double b) { return b < a || b != b ? b : a; }

/// Bound of |n . x| for x between two bounds; times 0 infinity is 0 too, as x is finite.
double largest_along(Point3 lower, Point3 upper, Point3 n) {
    double low = 0.0, high = 0.0;
    const auto add = [&](double a, double b, double factor) {
        if (factor == 0.0) return;
        low += factor > 0.0 ? factor * a : factor * b;
        high += factor > 0.0 ? factor * b : factor * a;
    };
    add(lower.x, upper.x, n.x);
    add(lower.y, upper.y, n.y);
    add(lower.z, upper.z, n.z);
    return larger_or_nan(std::abs(low), std::abs(high));
}

ParameterBox box_of(const ParameterTriangle& t) {
    return {
        {std::min(std::min(t[0].x, t[1].x), t[2].x), std::min(std::min(t[0].y, t[1].y), t[2].y)},
        {std::max(std::max(t[0].x, t[1].x), t[2].x), std::max(std::max(t[0].y, t[1].y), t[2].y)}};
}

/// A triangle cut in four by the middles of its sides.
std::array<ParameterTriangle, 4> in_four(const ParameterTriangle& t) {
    const auto middle = [](Point2 p, Point2 q) {
        return Point2{0.5 * (p.x + q.x), 0.5 * (p.y + q.y)};
    };
    const Point2 ab = middle(t[0], t[1]), bc = middle(t[1], t[2]), ca = middle(t[2], t[0]);
    return {{{t[0], ab, ca}, {ab, t[1], bc}, {ca, bc, t[2]}, {ab, bc, ca}}};
}

/// Most of l0 l1 a + l1 l2 b + l2 l0 c for barycentric l: within the triangle, or amid an edge.
double most_between(double a, double b, double c) {
    const double amid = larger_or_nan(larger_or_nan(a, b), c) / 4.0;
    if (!(a * (b + c - a) > 0.0 && b * (c + a - b) > 0.0 && c * (a + b - c) > 0.0)) return amid;
    const double inner = 2.0 * (a * b + b * c + c * a) - a * a - b * b - c * c;
    return larger_or_nan(inner > 0.0 ? a * b * c / inner : 0.0, amid);
}

/// A part of a triangle.
struct Part {
    std::int32_t triangle;
    ParameterTriangle uv;
};

class Search {
  public:
    Search(const Surface& surface, const SampledTriangles& triangles)
        : surface_(surface), triangles_(triangles) {
        found_.bounded.resize(triangles.uv.size(), Bounded::NOT);
    }

    HiddenBounds run(int levels) {
        Array<Part> parts;
        for (std::size_t k = 0; k < triangles_.uv.size(); ++k)
            parts.push_back({static_cast<std::int32_t>(k), triangles_.uv[k]});
        in_blocks(parts, [&](std::span<const Part> some) { at_once(some); });
        for (int level = 0; level <= levels && !parts.empty(); ++level) {
            Array<Part> open;
            for (const Part& part : parts)
                if (is_open(part.triangle)) open.push_back(part);
            parts.clear();
            in_blocks(open, [&](std::span<const Part> some) {
                interpolated(some, level < levels ? &parts : nullptr);
            });
        }
        return std::move(found_);
    }

  private:
    /// In parts until one of them is not; those at once are done with.
    [[nodiscard]] bool is_open(std::int32_t triangle) const {
        return found_.bounded[triangle] == Bounded::IN_PARTS;
    }

    /// Call work(some parts) block after block, with the bounds over their boxes.
    template <class Work>
    void in_blocks(const Array<Part>& parts, const Work& work) {
        for (std::size_t k = 0; k < parts.size(); k += HIDDEN_BLOCK) {
            const std::span<const Part> some{parts.data() + k,
                                             std::min(HIDDEN_BLOCK, parts.size() - k)};
            cells_.clear();
            for (const Part& part : some) cells_.push_back(box_of(part.uv));
            lower_.resize(BOUNDS * some.size());
            upper_.resize(BOUNDS * some.size());
            if (found_.status == SurfaceStatus::DONE)
                found_.status = surface_.all_bounds({cells_.data(), cells_.size()},
                                                    {lower_.data(), lower_.size()},
                                                    {upper_.data(), upper_.size()});
            if (found_.status == SurfaceStatus::DONE) work(some);
        }
    }

    void at_once(std::span<const Part> some) {
        for (std::size_t i = 0; i < some.size(); ++i) {
            const std::int32_t k = some[i].triangle;
            const Point3 n = triangles_.normal[k];
            const Point2 d = cells_[i].high - cells_[i].low;
            std::array<double, 3> bends;
            for (std::size_t j = 0; j < 3; ++j)
                bends[j] =
                    largest_along(lower_[BOUNDS * i + UU + j], upper_[BOUNDS * i + UU + j], n);
            const double height =
                (d.x * d.x * bends[0] + 2.0 * d.x * d.y * bends[1] + d.y * d.y * bends[2]) / 8.0;
            found_.bounded[k] = triangles_.seen[k] + 0.25 * height <= triangles_.tolerance[k]
                                    ? Bounded::AT_ONCE
                                    : Bounded::IN_PARTS;
        }
    }

    /// Where parts are not within the tolerance they are cut in four; without ``next`` they fail.
    void interpolated(std::span<const Part> some, Array<Part>* next) {
        uv_.clear();
        for (const Part& part : some)
            for (const Point2 corner : part.uv) uv_.push_back(corner);
        corners_.resize(uv_.size());
        found_.status =
            surface_.evaluate({uv_.data(), uv_.size()}, 0, {corners_.data(), corners_.size()});
        if (found_.status != SurfaceStatus::DONE) return;
        for (std::size_t i = 0; i < some.size(); ++i) {
            if (is_within(i, some[i])) continue;
            if (next == nullptr) {
                found_.bounded[some[i].triangle] = Bounded::NOT;
                continue;
            }
            for (const ParameterTriangle& quarter : in_four(some[i].uv))
                next->push_back({some[i].triangle, quarter});
        }
    }

    [[nodiscard]] bool is_within(std::size_t i, const Part& part) const {
        const Point3 n = triangles_.normal[part.triangle];
        const Point3 corner = triangles_.corner[part.triangle];
        double height = 0.0;
        std::array<double, 3> bend;  // along each edge
        for (std::size_t k = 0; k < 3; ++k) {
            height = larger_or_nan(height, std::abs(dot(corners_[3 * i + k] - corner, n)));
            bend[k] = bend_along(i, part.uv[(k + 1) % 3] - part.uv[k], n);
        }
        const double bound = 0.5 * most_between(bend[0], bend[1], bend[2]);
        return height + bound <= triangles_.tolerance[part.triangle];
    }

    /// Bound of |e''| along d over the box of part i.
    [[nodiscard]] double bend_along(std::size_t i, Point2 d, Point3 n) const {
        const std::array<double, 3> weights{d.x * d.x, 2.0 * d.x * d.y, d.y * d.y};
        double low = 0.0, high = 0.0;
        for (std::size_t j = 0; j < 3; ++j) {
            const Point3 a = lower_[BOUNDS * i + UU + j], b = upper_[BOUNDS * i + UU + j];
            const Point3 times = weights[j] * n;
            for (const auto& [factor, from, to] :
                 {std::array{times.x, a.x, b.x}, std::array{times.y, a.y, b.y},
                  std::array{times.z, a.z, b.z}}) {
                high += larger_or_nan(factor * from, factor * to);
                low += smaller(factor * from, factor * to);
            }
        }
        return larger_or_nan(high, -low);
    }

    const Surface& surface_;
    const SampledTriangles& triangles_;
    HiddenBounds found_;
    Array<ParameterBox> cells_;
    Array<Point3> lower_, upper_, corners_;
    Array<Point2> uv_;
};

}  // namespace

HiddenBounds hidden_bounds(const Surface& surface, const SampledTriangles& triangles, int levels) {
    return Search(surface, triangles).run(levels);
}

}  // namespace surfmesh
