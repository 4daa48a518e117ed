#include "quality/hidden_bounds.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "quality/bend_models.hpp"

namespace surfmesh {
namespace {

constexpr std::size_t HIDDEN_BLOCK = 1024;              // parts looked at together
constexpr std::int32_t GATHERED = 1024;                 // triangles whose groups are
constexpr std::array<std::size_t, 2> GROUPS = {32, 4};  // triangles over one box
constexpr std::size_t MODELLED = 8;                     // triangles to a model
constexpr double NO_AREA = 1e-12;  // of the square of the longest side: it has no normal
constexpr double BETWEEN = 4.0;    // linear interpolation errs so much less between the samples

/// A triangle cut in four by the middles of its sides.
std::array<ParameterTriangle, 4> in_four(const ParameterTriangle& t) {
    const auto middle = [](Point2 p, Point2 q) {
        return Point2{0.5 * (p.x + q.x), 0.5 * (p.y + q.y)};
    };
    const Point2 ab = middle(t[0], t[1]), bc = middle(t[1], t[2]), ca = middle(t[2], t[0]);
    return {{{t[0], ab, ca}, {ab, t[1], bc}, {ca, bc, t[2]}, {ab, bc, ca}}};
}

/// A triangle of the mesh as it is looked at.
struct Sampled {
    ParameterTriangle uv;
    Point3 normal;  // twice as long as the triangle is large: so are lengths along it
    double length;  // of the normal
    double slack;   // along the normal: what may hide, less what its samples have seen
    std::int32_t number;
    bool whole;
};

/// A part of a triangle.
struct Part {
    std::int32_t triangle;
    ParameterTriangle uv;
};

class Search {
  public:
    Search(const Surface& surface, const MeasuredMesh& mesh, const SampledTriangles& triangles)
        : surface_(surface),
          smooth_(dynamic_cast<const FourthDerivatives*>(&surface)),
          mesh_(mesh),
          triangles_(triangles) {
        found_.bounded.resize(triangles.rows.size(), 1);
    }

    HiddenBounds run(int levels) {
        Array<Part> left = left_by_groups();
        if (smooth_ != nullptr) keep_open_by_models(left);
        in_parts(std::move(left), levels);
        if (found_.status != SurfaceStatus::DONE) found_.bounded.fill(0);
        return std::move(found_);
    }

  private:
    /// Triangle number i, or false where it has no area.
    bool look_up(std::int32_t i, Sampled& t) const {
        const TriangleCorners &k = mesh_.triangles[triangles_.rows[i]],
                              &q = mesh_.uv_triangles[triangles_.rows[i]];
        const Point3 ab = mesh_.points[k.b] - mesh_.points[k.a],
                     ac = mesh_.points[k.c] - mesh_.points[k.a], bc = ac - ab, n = cross(ab, ac);
        const double length = norm(n);
        if (!(length > NO_AREA * std::max({dot(ab, ab), dot(bc, bc), dot(ac, ac)}))) return false;
        t.uv = {mesh_.uv[q.a], mesh_.uv[q.b], mesh_.uv[q.c]};
        t.normal = n;
        t.length = length;
        t.slack = length * (triangles_.tolerance[i] - triangles_.seen[i]);
        t.number = i;
        t.whole = triangles_.whole[i] != 0;
        return true;
    }

    /// Look at triangles that follow each other, neighbours as a rule, over one box around them: the
    /// triangles that are left.
    Array<Part> left_by_groups() {
        Array<Part> left;
        Array<Sampled> some;
        const auto count = static_cast<std::int32_t>(triangles_.rows.size());
        for (std::int32_t first = 0; first < count; first += GATHERED) {
            some.clear();
            for (std::int32_t i = first; i < std::min(first + GATHERED, count); ++i)
                if (Sampled t; look_up(i, t)) some.push_back(t);
            for (std::size_t level = 0; level < GROUPS.size() && !some.empty(); ++level)
                keep_open(some, GROUPS[level]);
            for (const Sampled& t : some) left.push_back({t.number, t.uv});
        }
        return left;
    }

    /// Those triangles of which bounds over boxes around groups say nothing.
    void keep_open(Array<Sampled>& some, std::size_t group) {
        cells_.clear();
        for (std::size_t k = 0; k < some.size(); ++k) add_to_cells(some[k].uv, k % group == 0);
        if (!bound_cells()) return;
        std::size_t kept = 0;
        for (std::size_t k = 0; k < some.size(); k += group) {
            const MiddleBends& around = bends_[k / group];
            for (std::size_t j = k; j < std::min(k + group, some.size()); ++j)
                if (!hides_nothing(some[j], around)) some[kept++] = some[j];
        }
        some.resize(kept);
    }

    /// Into the last cell, or a new one.
    void add_to_cells(const ParameterTriangle& uv, bool is_first) {
        if (is_first)
            cells_.push_back(box_of(uv));
        else
            cells_.back() = around(cells_.back(), box_of(uv));
    }

    /// Those triangles of which models of the second derivatives around groups say nothing.
    void keep_open_by_models(Array<Part>& all) {
        cells_.clear();
        for (std::size_t k = 0; k < all.size(); ++k) add_to_cells(all[k].uv, k % MODELLED == 0);
        Array<BendModel> models;
        const auto status = bend_models(*smooth_, cells_, models);
        if (status == SurfaceStatus::FAILED) found_.status = status;
        if (status != SurfaceStatus::DONE) return;
        std::size_t kept = 0;
        for (std::size_t k = 0; k < all.size(); ++k) {
            const BendModel& model = models[k / MODELLED];
            Sampled t{};
            if (!look_up(all[k].triangle, t)) continue;
            const bool is_done = model.is_known() && hides_nothing(t, model.over(box_of(t.uv)));
            if (!is_done) all[kept++] = all[k];
        }
        all.resize(kept);
    }

    /// Do bounds over a cell around a triangle say that it hides nothing?
    [[nodiscard]] static bool hides_nothing(const Sampled& t, const MiddleBends& bends) {
        return t.whole ? hides_nothing_in_box(t, bends)
                       : bends.err_within(BETWEEN * t.slack, t.uv, t.normal);
    }
    /// Nor all of the box around it?
    [[nodiscard]] static bool hides_nothing_in_box(const Sampled& t, const MiddleBends& bends) {
        const ParameterBox box = box_of(t.uv);
        return bends.err_within(BETWEEN * t.slack, box.high - box.low, t.normal);
    }

    /// Bounds over ``cells_`` into ``bends_``; false where the surface has failed.
    bool bound_cells() {
        lower_.resize(BENDS * cells_.size());
        upper_.resize(BENDS * cells_.size());
        if (found_.status == SurfaceStatus::DONE)
            found_.status = surface_.bend_bounds({cells_.data(), cells_.size()},
                                                 {lower_.data(), BENDS * cells_.size()},
                                                 {upper_.data(), BENDS * cells_.size()});
        if (found_.status != SurfaceStatus::DONE) return false;
        bends_.clear();
        for (std::size_t k = 0; k < lower_.size(); k += BENDS)
            bends_.push_back(MiddleBends::between(lower_.data() + k, upper_.data() + k));
        return true;
    }

    /// Bounds over the boxes of parts.
    bool bound(std::span<const Part> some) {
        cells_.clear();
        for (const Part& part : some) cells_.push_back(box_of(part.uv));
        return bound_cells();
    }

    /// Look at triangles over their own boxes, where they are left at their parts, cut in four so
    /// often. Those of which a part is left then are not bounded.
    void in_parts(Array<Part> parts, int levels) {
        for (int level = 0; level <= levels && !parts.empty(); ++level) {
            Array<Part> open, next;
            for (const Part& part : parts)
                if (found_.bounded[part.triangle] != 0) open.push_back(part);
            for (std::size_t k = 0; k < open.size(); k += HIDDEN_BLOCK) {
                std::span<Part> some{open.data() + k, std::min(HIDDEN_BLOCK, open.size() - k)};
                if (!bound(some)) return;
                if (level == 0) some = left_alone(some);
                if (!some.empty()) interpolated(some, level < levels ? &next : nullptr);
            }
            parts = std::move(next);
        }
    }

    /// Those that bounds over their own boxes leave, and these bounds, moved to the front.
    std::span<Part> left_alone(std::span<Part> some) {
        std::size_t kept = 0;
        for (std::size_t i = 0; i < some.size(); ++i) {
            Sampled t{};
            if (!look_up(some[i].triangle, t) || hides_nothing(t, bends_[i])) continue;
            if (hides_nothing_in_box(t, bends_[i])) continue;
            if (t.whole) {  // its parts are not all of its box
                found_.bounded[t.number] = 0;
                continue;
            }
            bends_[kept] = bends_[i];
            some[kept++] = some[i];
        }
        return some.first(kept);
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
            const double limit = t.length * triangles_.tolerance[t.number] - height(i, t);
            if (bends_[i].err_within(limit, part.uv, t.normal)) continue;
            if (next == nullptr) {
                found_.bounded[t.number] = 0;
                continue;
            }
            for (const ParameterTriangle& quarter : in_four(part.uv))
                next->push_back({t.number, quarter});
        }
    }

    /// The largest distance of the corners of part i from the plane of their triangle, along its
    /// normal.
    [[nodiscard]] double height(std::size_t i, const Sampled& t) const {
        const Point3 corner = mesh_.points[mesh_.triangles[triangles_.rows[t.number]].a];
        double largest = 0.0;
        for (std::size_t k = 3 * i; k < 3 * i + 3; ++k)
            largest = larger_or_nan(largest, std::abs(dot(corners_[k] - corner, t.normal)));
        return largest;
    }

    const Surface& surface_;
    const FourthDerivatives* smooth_;  // the same, or null where it has none
    const MeasuredMesh& mesh_;
    const SampledTriangles& triangles_;
    HiddenBounds found_;
    Array<ParameterBox> cells_;
    Array<MiddleBends> bends_;
    Array<Point3> lower_, upper_, corners_;
    Array<Point2> uv_;
};

}  // namespace

HiddenBounds hidden_bounds(const Surface& surface, const MeasuredMesh& mesh,
                           const SampledTriangles& triangles, int levels) {
    return Search(surface, mesh, triangles).run(levels);
}

}  // namespace surfmesh
