#include "quality/hidden_bounds.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace surfmesh {
namespace {

constexpr std::size_t HIDDEN_BLOCK = 1024;  // parts looked at together
constexpr std::size_t GATHERED = 4096;      // triangles whose groups are looked at together
constexpr std::array<std::size_t, 3> GROUPS = {32, 8, 2};  // triangles over one box
constexpr double FEW = 0.25, MOST = 0.75;  // of the triangles in groups: then smaller, larger ones
constexpr std::size_t BENDS = 3;           // of the bounds of a cell: r_uu, r_uv, r_vv
constexpr double NO_AREA = 1e-12;          // of the square of the longest side: it has no normal
constexpr int MOST_BITS = 8;               // of a place's number along either parameter

/// The larger_or_nan of two, NaN where one of them is: then nothing is bounded.
double larger_or_nan(double a, double b) { return b > a || b != b ? b : a; }

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

/// A triangle of the mesh as it is looked at.
struct Sampled {
    ParameterTriangle uv;
    Point3 normal;  // of length 1
    double slack;   // what may hide, less what its samples have seen
    std::int32_t number;
    bool whole;
};

/// Bounds of second derivatives over a cell as their middles and half their widths: along n they
/// are n . middle, give or take |n| . half.
struct MiddleBends {
    std::array<Point3, BENDS> middle, half;

    MiddleBends(const Point3* lower, const Point3* upper) {
        for (std::size_t j = 0; j < BENDS; ++j) {
            middle[j] = 0.5 * (lower[j] + upper[j]);
            half[j] = 0.5 * (upper[j] - lower[j]);
        }
    }

    /// Does linear interpolation over a triangle within the cell err by so much at most? Not where
    /// a bound is not finite.
    [[nodiscard]] bool err_within(double limit, const ParameterTriangle& uv, Point3 n) const {
        const Point3 size = {std::abs(n.x), std::abs(n.y), std::abs(n.z)};
        std::array<double, BENDS> along, around;
        for (std::size_t j = 0; j < BENDS; ++j) {
            along[j] = dot(n, middle[j]);
            around[j] = dot(size, half[j]);
        }
        std::array<double, 3> bend;  // along each edge
        for (std::size_t k = 0; k < 3; ++k) {
            const Point2 d = uv[k == 2 ? 0 : k + 1] - uv[k];
            const double uu = d.x * d.x, twice = 2.0 * d.x * d.y, vv = d.y * d.y;
            bend[k] = std::abs(uu * along[0] + twice * along[1] + vv * along[2]) +
                      (uu * around[0] + std::abs(twice) * around[1] + vv * around[2]);
        }
        if (std::max(bend[0], std::max(bend[1], bend[2])) <= 6.0 * limit) return true;
        return 0.5 * most_between(bend[0], bend[1], bend[2]) <= limit;
    }
};

/// A part of a triangle.
struct Part {
    std::int32_t triangle;
    ParameterTriangle uv;
};

/// Every second bit of a number is one of these.
std::uint32_t spread(std::uint32_t bits) {
    bits = (bits | bits << 4) & 0x0f0fU;
    bits = (bits | bits << 2) & 0x3333U;
    return (bits | bits << 1) & 0x5555U;
}

class Search {
  public:
    Search(const Surface& surface, const MeasuredMesh& mesh, const SampledTriangles& triangles)
        : surface_(surface), mesh_(mesh), triangles_(triangles) {
        found_.bounded.resize(triangles.rows.size(), 1);
    }

    HiddenBounds run(int levels) {
        const Array<Part> left = left_by_groups();
        Array<Part> parts;
        in_blocks(left,
                  [&](std::span<const Part> some) { alone(some, levels > 0 ? &parts : nullptr); });
        for (int level = 1; level <= levels && !parts.empty(); ++level) {
            Array<Part> open;
            for (const Part& part : parts)
                if (found_.bounded[part.triangle] != 0) open.push_back(part);
            parts.clear();
            in_blocks(open, [&](std::span<const Part> some) {
                interpolated(some, level < levels ? &parts : nullptr);
            });
        }
        if (found_.status != SurfaceStatus::DONE) found_.bounded.fill(0);
        return std::move(found_);
    }

  private:
    /// Numbers of the triangles, neighbours after each other: by cells of a grid over (u, v), along
    /// Morton's curve.
    [[nodiscard]] Array<std::int32_t> in_order() const {
        const std::size_t count = triangles_.rows.size();
        int bits = 1;
        while (bits < MOST_BITS && (std::size_t{4} << 2 * bits) < count) ++bits;
        const ParameterBox domain = surface_.domain();
        const double cells = 1 << bits;
        const auto place = [cells](double x, double first, double last) {
            const double at = (x - first) / (last - first) * cells;
            return static_cast<std::uint32_t>(at > 0.0 ? std::min(at, cells - 1.0) : 0.0);
        };
        Array<std::uint32_t> cell(count);
        Array<std::int32_t> first((std::size_t{1} << 2 * bits) + 1, 0), order(count);
        for (std::size_t i = 0; i < count; ++i) {
            const Point2 corner = mesh_.uv[mesh_.uv_triangles[triangles_.rows[i]].a];
            cell[i] = spread(place(corner.x, domain.low.x, domain.high.x)) |
                      spread(place(corner.y, domain.low.y, domain.high.y)) << 1;
            ++first[cell[i] + 1];
        }
        for (std::size_t k = 1; k < first.size(); ++k) first[k] += first[k - 1];
        for (std::size_t i = 0; i < count; ++i)
            order[first[cell[i]]++] = static_cast<std::int32_t>(i);
        return order;
    }

    /// Triangle number i, or false where it has no area.
    bool look_up(std::int32_t i, Sampled& t) const {
        const TriangleCorners &k = mesh_.triangles[triangles_.rows[i]],
                              &q = mesh_.uv_triangles[triangles_.rows[i]];
        const Point3 ab = mesh_.points[k.b] - mesh_.points[k.a],
                     ac = mesh_.points[k.c] - mesh_.points[k.a], bc = ac - ab, n = cross(ab, ac);
        const double length = norm(n);
        if (!(length > NO_AREA * std::max({dot(ab, ab), dot(bc, bc), dot(ac, ac)}))) return false;
        t.uv = {mesh_.uv[q.a], mesh_.uv[q.b], mesh_.uv[q.c]};
        t.normal = (1.0 / length) * n;
        t.slack = triangles_.tolerance[i] - triangles_.seen[i];
        t.number = i;
        t.whole = triangles_.whole[i] != 0;
        return true;
    }

    /// Look at triangles that follow each other over one box around them, groups smaller and
    /// smaller: the triangles that are left.
    Array<Part> left_by_groups() {
        Array<Part> left;
        Array<Sampled> some;
        std::size_t largest = 0;
        const Array<std::int32_t> order = in_order();
        for (std::size_t first = 0; first < order.size(); first += GATHERED) {
            some.clear();
            for (std::size_t k = first; k < std::min(first + GATHERED, order.size()); ++k)
                if (Sampled t; look_up(order[k], t)) some.push_back(t);
            const std::size_t start = largest;
            for (std::size_t level = start; level < GROUPS.size() && !some.empty(); ++level) {
                const double all = static_cast<double>(some.size());
                keep_open(some, GROUPS[level]);
                const double done = 1.0 - static_cast<double>(some.size()) / all;
                if (level != start) continue;
                if (done < FEW && largest + 1 < GROUPS.size()) ++largest;
                if (done > MOST && largest > 0) --largest;
            }
            for (const Sampled& t : some) left.push_back({t.number, t.uv});
        }
        return left;
    }

    /// Those triangles of which bounds over boxes around groups say nothing.
    void keep_open(Array<Sampled>& some, std::size_t group) {
        cells_.clear();
        for (std::size_t k = 0; k < some.size(); ++k) {
            if (k % group == 0)
                cells_.push_back(box_of(some[k].uv));
            else
                cells_.back() = around(cells_.back(), box_of(some[k].uv));
        }
        if (!bound_cells()) return;
        std::size_t kept = 0;
        for (std::size_t k = 0; k < some.size(); k += group) {
            const MiddleBends around = bends(k / group);
            for (std::size_t j = k; j < std::min(k + group, some.size()); ++j) {
                const Sampled& t = some[j];
                const bool done = t.whole ? bends_little(t, k / group)
                                          : around.err_within(4.0 * t.slack, t.uv, t.normal);
                if (!done) some[kept++] = t;
            }
        }
        some.resize(kept);
    }

    /// Bounds over ``cells_``; false where the surface has failed.
    bool bound_cells() {
        lower_.resize(BENDS * cells_.size());
        upper_.resize(BENDS * cells_.size());
        if (found_.status == SurfaceStatus::DONE)
            found_.status = surface_.bend_bounds({cells_.data(), cells_.size()},
                                                 {lower_.data(), BENDS * cells_.size()},
                                                 {upper_.data(), BENDS * cells_.size()});
        return found_.status == SurfaceStatus::DONE;
    }

    /// Those over a cell.
    [[nodiscard]] MiddleBends bends(std::size_t cell) const {
        return {lower_.data() + BENDS * cell, upper_.data() + BENDS * cell};
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
    void alone(std::span<const Part> some, Array<Part>* next) {
        Array<Part> open;
        for (std::size_t i = 0; i < some.size(); ++i) {
            Sampled t{};
            if (!look_up(some[i].triangle, t) || bends_little(t, i)) continue;
            if (t.whole) {
                found_.bounded[t.number] = 0;
                continue;
            }
            if (bends(i).err_within(4.0 * t.slack, t.uv, t.normal)) continue;
            for (auto* bounds : {&lower_, &upper_})
                std::copy_n(bounds->begin() + BENDS * i, BENDS,
                            bounds->begin() + BENDS * open.size());
            open.push_back(some[i]);
        }
        if (!open.empty()) interpolated({open.data(), open.size()}, next);
    }

    /// Does the surface bend little over the box of a triangle, by the bounds of a cell around it?
    [[nodiscard]] bool bends_little(const Sampled& t, std::size_t cell) const {
        const ParameterBox box = box_of(t.uv);
        const Point2 d = box.high - box.low;
        std::array<double, BENDS> bends;
        for (std::size_t j = 0; j < BENDS; ++j)
            bends[j] = largest_along(lower_[BENDS * cell + j], upper_[BENDS * cell + j], t.normal);
        const double height =
            (d.x * d.x * bends[0] + 2.0 * d.x * d.y * bends[1] + d.y * d.y * bends[2]) / 8.0;
        return 0.25 * height <= t.slack;
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
        Sampled t{};
        t.number = -1;
        for (std::size_t i = 0; i < some.size(); ++i) {
            const Part& part = some[i];
            if (part.triangle != t.number) look_up(part.triangle, t);
            const double limit = triangles_.tolerance[t.number] - height(i, t);
            if (bends(i).err_within(limit, part.uv, t.normal)) continue;
            if (next == nullptr) {
                found_.bounded[t.number] = 0;
                continue;
            }
            for (const ParameterTriangle& quarter : in_four(part.uv))
                next->push_back({t.number, quarter});
        }
    }

    /// The largest distance of the corners of part i from the plane of their triangle.
    [[nodiscard]] double height(std::size_t i, const Sampled& t) const {
        const Point3 corner = mesh_.points[mesh_.triangles[triangles_.rows[t.number]].a];
        double largest = 0.0;
        for (std::size_t k = 3 * i; k < 3 * i + 3; ++k)
            largest = larger_or_nan(largest, std::abs(dot(corners_[k] - corner, t.normal)));
        return largest;
    }

    const Surface& surface_;
    const MeasuredMesh& mesh_;
    const SampledTriangles& triangles_;
    HiddenBounds found_;
    Array<ParameterBox> cells_;
    Array<Point3> lower_, upper_, corners_;
    Array<Point2> uv_;
};

}  // namespace

HiddenBounds hidden_bounds(const Surface& surface, const MeasuredMesh& mesh,
                           const SampledTriangles& triangles, int levels) {
    return Search(surface, mesh, triangles).run(levels);
}

}  // namespace surfmesh
