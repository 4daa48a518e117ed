#include "fields/gradation.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "fields/node_neighbours.hpp"
#include "fields/size_queue.hpp"
#include "fields/stretched_gradation.hpp"

namespace surfmesh {
namespace {

// Relative change of a size that is not spread on its own.
constexpr double TOLERANCE = 1e-6, STRETCHED_TOLERANCE = 5e-4;

double squared(double x) { return x * x; }

double squared_distance(Point3 a, Point3 b) {
    return squared(a.x - b.x) + squared(a.y - b.y) + squared(a.z - b.z);
}

/// Isotropic sizes that grow from one node to those around it.
///
/// Most pairs and triangles allow what they have. A bound that rounding cannot reach says so
/// without a root: SURE below one for pairs, and for triangles the area from the three squares
/// of sides with what it may be wrong by.
class IsotropicGradation {
  public:
    IsotropicGradation(const GradedSizes& sizes, const NodeNeighbours& neighbours,
                       std::int32_t number)
        : neighbours_(neighbours),
          size_(sizes.size),
          changed_(sizes.changed),
          slope_(sizes.slope),
          number_(number) {
        nodes_.reserve(size_.size());
        for (std::size_t n = 0; n < size_.size(); ++n) nodes_.push_back({sizes.point[n], size_[n]});
    }

    [[nodiscard]] double key(Node n) const { return nodes_[n].size; }

    /// Do the sizes at the corners of a quarter surely differ by no more than is allowed?
    [[nodiscard]] bool is_level(const Quarter& k) const {
        const auto &p = nodes_[k.p], &q = nodes_[k.q], &r = nodes_[k.r], &s = nodes_[k.s];
        const auto [low, high] = std::minmax({p.size, q.size, r.size, s.size});
        const double above = high - low;
        if (above == 0.0) return true;
        const double pq = squared_distance(p.point, q.point),
                     qr = squared_distance(q.point, r.point);
        const double rs = squared_distance(r.point, s.point),
                     ps = squared_distance(p.point, s.point);
        const double pr = squared_distance(p.point, r.point),
                     qs = squared_distance(q.point, s.point);
        if (above * above >= SURE * (slope_ * slope_ * std::min({pq, qr, rs, ps, pr, qs})))
            return false;
        return is_level(above, pq, ps, qs) && is_level(above, pq, pr, qr) &&
               is_level(above, qr, qs, rs) && is_level(above, rs, pr, ps);
    }

    /// Lower the others of each quarter to what grows from p, and then from the sides that end
    /// there: a corner sees the two triangles of a diagonal each way.
    ///
    ///      s --- r        r is seen from p q and p s, q from p s, s from p q
    ///      |  x  |
    ///      p --- q
    void visit(Node p, SizeQueue& queue) {
        const bool is_new = changed_[p] >= number_;
        neighbours_.for_quarters(p, [&](const Quarter& k) {
            if (!is_new && changed_[k.q] < number_ && changed_[k.r] < number_ &&
                changed_[k.s] < number_)
                return;  // graded in an earlier round
            const double hq = nodes_[k.q].size, hr = nodes_[k.r].size, hs = nodes_[k.s].size;
            const double largest = std::max(hr, std::max(hq, hs));
            if (largest <= std::min(nodes_[p].size, std::min(hq, hs))) return;
            const Point3 at = nodes_[p].point;
            const Point3 q = nodes_[k.q].point, r = nodes_[k.r].point, s = nodes_[k.s].point;
            const double pq = squared_distance(at, q), pr = squared_distance(at, r);
            const double ps = squared_distance(at, s), qs = squared_distance(q, s);
            limit(k.q, p, pq, queue);
            limit(k.r, p, pr, queue);
            limit(k.s, p, ps, queue);
            limit_across({k.r, p, k.q, pq, pr, squared_distance(q, r)}, queue);
            limit_across({k.r, p, k.s, ps, pr, squared_distance(r, s)}, queue);
            limit_across({k.q, p, k.s, ps, pq, qs}, queue);
            limit_across({k.s, p, k.q, pq, ps, qs}, queue);
        });
        neighbours_.for_joined(p, [&](Node n) {
            limit(n, p, squared_distance(nodes_[p].point, nodes_[n].point), queue);
        });
    }

  private:
    static constexpr double SURE = 1.0 - 1e-10, WRONG = 1e-12;

    struct SizeAtPoint {
        Point3 point;
        double size;
    };
    /// A node c over the side between a and b, and the squares of the distances.
    struct Triangle {
        Node c, a, b;
        double ab, ac, bc;
    };

    void lower(Node node, double size, double change, SizeQueue& queue) {
        nodes_[node].size = size_[node] = size;
        changed_[node] = number_;
        queue.lowered(node, size, change);
    }

    /// Let the size of n not exceed that of p by more than slope times their distance.
    void limit(Node n, Node p, double square, SizeQueue& queue) {
        const double above = nodes_[n].size - nodes_[p].size;
        if (above <= 0.0 || above * above < SURE * (slope_ * slope_ * square)) return;
        const double size = nodes_[p].size + slope_ * std::sqrt(square);
        if (nodes_[n].size > size) lower(n, size, (nodes_[n].size - size) / size, queue);
    }

    /// Lower the size of c to what grows from the segment between a and b, sizes linear on it.
    ///
    /// The formula of Hopf and Lax on a flat triangle (Bornemann and Rasch 2006, section 3): with q
    /// and p the coordinates of c along ab and away from it, and k the rise along ab per length
    /// over the slope, the least of  h(x) + slope |c - x|  lies at  q - k p / sqrt(1 - k^2)  from
    /// a. Where that is beyond an end, the end decides, and `limit` has seen to it.
    void limit_across(const Triangle& t, SizeQueue& queue) {
        const double ha = nodes_[t.a].size, hb = nodes_[t.b].size, hc = nodes_[t.c].size;
        const double above = hc - std::min(ha, hb);
        // what comes from between a and b is above both, where the angle at c is not obtuse
        if (hc <= std::max(ha, hb) && t.ac + t.bc >= t.ab) return;
        if (above <= 0.0 || is_level(above, t.ab, t.ac, t.bc)) return;
        const Point3 a = nodes_[t.a].point;
        const Point3 ab = nodes_[t.b].point - a, ac = nodes_[t.c].point - a;
        const double onward = dot(ab, ac);
        const double area = dot(ac, ac) * t.ab - onward * onward;  // p^2 l^2
        if (t.ab == 0.0 || above * above * t.ab <= slope_ * slope_ * area) return;
        const double l = std::sqrt(t.ab), q = onward / l;
        const double k = (hb - ha) / (l * slope_), free = 1.0 - k * k;
        if (free <= 0.0) return;
        const double root = std::sqrt(free), p = std::sqrt(std::max(area, 0.0)) / l;
        const double from_a = q - k * p / root;
        if (from_a <= 0.0 || from_a >= l) return;
        const double allowed = ha + slope_ * (k * q + p * root);
        if (hc <= allowed) return;
        const double change = (hc - allowed) / allowed;
        if (change > ROUNDING) lower(t.c, allowed, change, queue);
    }

    /// Is c surely no farther above the side ab of its triangle than the slope allows?
    [[nodiscard]] bool is_level(double above, double ab, double ac, double bc) const {
        const double onward = 0.5 * (ab + ac - bc), sum = ab + ac + bc;
        const double area = ac * ab - onward * onward - WRONG * (sum * sum);
        return above * above * ab < SURE * (slope_ * slope_ * area);
    }

    const NodeNeighbours& neighbours_;
    std::span<double> size_;
    std::span<std::int32_t> changed_;
    double slope_;
    std::int32_t number_;
    Array<SizeAtPoint> nodes_;
};

/// Spread sizes from where something is new, the smallest first.
template <class Gradation>
GradationDone spread(std::span<const Patch> patches, std::span<const JoinedNodes> joined,
                     std::span<const std::int32_t> changed, std::int32_t number,
                     std::int64_t most_visits, double tolerance, Gradation gradation) {
    SizeQueue queue(changed.size(), tolerance);
    const auto is_new = [&](Node n) { return changed[n] >= number; };
    for (const Patch& patch : patches) {
        if (std::none_of(std::begin(patch.node), std::end(patch.node), is_new)) continue;
        for (const auto& c : CORNERS_OF_QUARTERS) {
            const Quarter quarter{patch.node[c[0]], patch.node[c[1]], patch.node[c[2]],
                                  patch.node[c[3]]};
            if (gradation.is_level(quarter)) continue;
            for (const Node n : {quarter.p, quarter.q, quarter.r, quarter.s})
                queue.seed(n, gradation.key(n));
        }
    }
    for (const auto [a, b] : joined)
        if (is_new(a) || is_new(b))
            for (const Node n : {a, b}) queue.seed(n, gradation.key(n));
    queue.start();
    GradationDone done{0, NIL, true};
    for (Node n = queue.take(); n != NIL; n = queue.take()) {
        if (done.visits == most_visits) return {done.visits, done.last, false};
        ++done.visits;
        done.last = n;
        gradation.visit(n, queue);
    }
    return done;
}

/// Frobenius norm of A^-1 (X - A), with the eigenvalues of A kept above `floor`.
double relative_error(SizeTensor x, SizeTensor a, double floor) {
    const SizeTensor d{x.xx - a.xx, x.xy - a.xy, x.yy - a.yy};
    a.xx += floor;
    a.yy += floor;
    const double det = determinant(a);
    const double e11 = a.yy * d.xx - a.xy * d.xy;
    const double e12 = a.yy * d.xy - a.xy * d.yy;
    const double e21 = a.xx * d.xy - a.xy * d.xx;
    const double e22 = a.xx * d.yy - a.xy * d.xy;
    return std::sqrt(e11 * e11 + e12 * e12 + e21 * e21 + e22 * e22) / det;
}

/// What the corners give at node i of a patch, bilinear.
SizeTensor by_corners(const PatchRoots& metric_root, int i) {
    SizeTensor x{0.0, 0.0, 0.0};
    for (int c = 0; c < 4; ++c) {
        const int column = 2 * (c % 2), row = 2 * (c / 2);
        const double w = 0.25 * (2 - std::abs(i % 3 - column)) * (2 - std::abs(i / 3 - row));
        x = x + w * metric_root[3 * row + column];
    }
    return x;
}

}  // namespace

GradationDone grade(std::span<const Patch> patches, std::span<const JoinedNodes> joined,
                    const GradedSizes& sizes, std::int32_t number, std::int64_t most_visits) {
    const NodeNeighbours neighbours(patches, joined, sizes.size.size());
    if (sizes.longer.empty())
        return spread(patches, joined, sizes.changed, number, most_visits, TOLERANCE,
                      IsotropicGradation(sizes, neighbours, number));
    return spread(patches, joined, sizes.changed, number, most_visits, STRETCHED_TOLERANCE,
                  StretchedGradation(sizes, neighbours, number));
}

PatchError patch_error(const PatchRoots& metric_root, Point2 step, double largest) {
    const double floor = 1.0 / largest;
    PatchError found{0.0, 0.0};
    for (const int i : {1, 3, 5, 7, 4}) {
        const SizeTensor x = by_corners(metric_root, i);
        found.error = std::max(found.error, relative_error(x, metric_root[i], floor));
    }
    for (const SizeTensor a : metric_root) {
        found.extent = std::max(found.extent, step.x * std::sqrt(a.xx * a.xx + a.xy * a.xy));
        found.extent = std::max(found.extent, step.y * std::sqrt(a.xy * a.xy + a.yy * a.yy));
    }
    return found;
}

}  // namespace surfmesh
