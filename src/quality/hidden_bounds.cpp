#include "quality/hidden_bounds.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace surfmesh {
namespace {

constexpr std::size_t HIDDEN_BLOCK = 1024;                    // triangles looked at together
constexpr std::size_t LARGEST_GROUP = 8, SMALLEST_GROUP = 2;  // of triangles, over one box
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

ParameterBox around(const ParameterBox& a, const ParameterBox& b) {
    return {{std::min(a.low.x, b.low.x), std::min(a.low.y, b.low.y)},
            {std::max(a.high.x, b.high.x), std::max(a.high.y, b.high.y)}};
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
        const Array<Part> left = left_by_groups();
        Array<Part> parts;
        in_blocks(left, [&](std::span<const Part> some) {
            at_once(some, levels > 0 ? &parts : nullptr);
        });
        for (int level = 1; level <= levels && !parts.empty(); ++level) {
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

    /// Look at triangles that follow each other, as a rule neighbours, over one box around them:
    /// what it says holds for the box of each. Those that it leaves; groups get smaller where it
    /// leaves many.
    Array<Part> left_by_groups() {
        Array<Part> left;
        std::size_t group = LARGEST_GROUP;
        const std::size_t count = triangles_.uv.size();
        for (std::size_t first = 0; first < count; first += HIDDEN_BLOCK) {
            const std::size_t end = std::min(first + HIDDEN_BLOCK, count), before = left.size();
            if (group > 1 && !bound_groups(first, end, group)) group = 1;
            for (std::size_t k = first; k < end; ++k) {
                const bool flat =
                    group > 1 && bends_little(k, box_of(triangles_.uv[k]), (k - first) / group);
                if (flat)
                    found_.bounded[k] = Bounded::AT_ONCE;
                else
                    left.push_back({static_cast<std::int32_t>(k), triangles_.uv[k]});
            }
            if (2 * (left.size() - before) > end - first)
                group = std::max(group / 2, SMALLEST_GROUP);
        }
        return left;
    }

    /// Bounds over the boxes around groups of triangles.
    bool bound_groups(std::size_t first, std::size_t end, std::size_t group) {
        cells_.clear();
        for (std::size_t k = first; k < end; ++k) {
            const ParameterBox box = box_of(triangles_.uv[k]);
            if ((k - first) % group == 0)
                cells_.push_back(box);
            else
                cells_.back() = around(cells_.back(), box);
        }
        return bound_cells();
    }

    /// Bounds over ``cells_``; false where the surface has failed.
    bool bound_cells() {
        lower_.resize(BOUNDS * cells_.size());
        upper_.resize(BOUNDS * cells_.size());
        if (found_.status == SurfaceStatus::DONE)
            found_.status = surface_.all_bounds({cells_.data(), cells_.size()},
                                                {lower_.data(), BOUNDS * cells_.size()},
                                                {upper_.data(), BOUNDS * cells_.size()});
        return found_.status == SurfaceStatus::DONE;
    }

    /// Call work(some parts) block after block, with the bounds over their boxes.
    template <class Work>
    void in_blocks(const Array<Part>& parts, const Work& work) {
        for (std::size_t k = 0; k < parts.size(); k += HIDDEN_BLOCK) {
            const std::span<const Part> some{parts.data() + k,
                                             std::min(HIDDEN_BLOCK, parts.size() - k)};
            cells_.clear();
            for (const Part& part : some) cells_.push_back(box_of(part.uv));
            if (bound_cells()) work(some);
        }
    }

    /// Triangles over their own boxes; those that are left are cut, by the same bounds.
    void at_once(std::span<const Part> some, Array<Part>* next) {
        Array<Part> open;
        for (std::size_t i = 0; i < some.size(); ++i) {
            const bool flat = bends_little(some[i].triangle, cells_[i], i);
            found_.bounded[some[i].triangle] = flat ? Bounded::AT_ONCE : Bounded::IN_PARTS;
            if (flat) continue;
            for (auto* bounds : {&lower_, &upper_})
                std::copy_n(bounds->begin() + BOUNDS * i, BOUNDS,
                            bounds->begin() + BOUNDS * open.size());
            open.push_back(some[i]);
        }
        if (!open.empty()) interpolated({open.data(), open.size()}, next);
    }

    /// Is triangle k, whose box this is, within its tolerance by the bounds of a cell around it?
    [[nodiscard]] bool bends_little(std::size_t k, const ParameterBox& box,
                                    std::size_t cell) const {
        const Point3 n = triangles_.normal[k];
        const Point2 d = box.high - box.low;
        std::array<double, 3> bends;
        for (std::size_t j = 0; j < 3; ++j)
            bends[j] =
                largest_along(lower_[BOUNDS * cell + UU + j], upper_[BOUNDS * cell + UU + j], n);
        const double height =
            (d.x * d.x * bends[0] + 2.0 * d.x * d.y * bends[1] + d.y * d.y * bends[2]) / 8.0;
        return triangles_.seen[k] + 0.25 * height <= triangles_.tolerance[k];
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
