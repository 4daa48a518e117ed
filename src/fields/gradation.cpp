#include "fields/gradation.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace surfmesh {
namespace {

constexpr double FINISHED_BELOW = 1e-3;  // relative change of a sweep

// How much rather the longer size is lowered than the shorter one, by what either contributes.
constexpr double LONGER_FIRST = 16.0;

// Of the square that a way is to be long in the metric: what is let pass, as turning metrics creep
// towards the rest in many sweeps.
constexpr double ENOUGH_ALONG = 0.98;

double squared(double x) { return x * x; }

double distance(Point3 a, Point3 b) {
    return std::sqrt(squared(a.x - b.x) + squared(a.y - b.y) + squared(a.z - b.z));
}

/// Let neither of the sizes of a and b exceed the other by more than slope times their distance.
///
/// Returns the relative change, and notes in `changed` which node it was.
double limit(const GradedSizes& s, Node a, Node b, std::int32_t sweep) {
    double &ha = s.size[a], &hb = s.size[b];
    if (ha == hb) return 0.0;
    const double rise = s.slope * distance(s.point[a], s.point[b]);
    if (ha > hb + rise) {
        const double change = ha - hb - rise;
        ha = hb + rise;
        s.changed[a] = sweep;
        return change / ha;
    }
    if (hb > ha + rise) {
        const double change = hb - ha - rise;
        hb = ha + rise;
        s.changed[b] = sweep;
        return change / hb;
    }
    return 0.0;
}

struct Direction {
    double along, left;
};

/// `along` of a in the tangent plane of b: components along and left of that of b.
///
/// Turned with the normal by the smallest rotation. Normals may be opposite across a joint.
Direction carried(const GradedSizes& sizes, Node a, Node b) {
    const Point3 n = sizes.normal[a], m = sizes.normal[b], t = sizes.along[a];
    const double c = dot(n, m);
    const double sign = c >= 0.0 ? 1.0 : -1.0;
    const double k = sign * dot(t, m) / (1.0 + std::abs(c));
    const double x = t.x - k * (n.x + sign * m.x);
    const double y = t.y - k * (n.y + sign * m.y);
    const double z = t.z - k * (n.z + sign * m.z);
    const Point3 s = sizes.along[b];
    const double along = x * s.x + y * s.y + z * s.z;
    const double left =
        x * (m.y * s.z - m.z * s.y) + y * (m.z * s.x - m.x * s.z) + z * (m.x * s.y - m.y * s.x);
    const double d = std::sqrt(along * along + left * left);
    if (d == 0.0) return {1.0, 0.0};
    return {along / d, left / d};
}

/// The metric of a in the axes of b: x for its longer, y for its shorter one.
struct CarriedMetric {
    double mx, my, mxy;
};

CarriedMetric carried_metric(const GradedSizes& s, Node a, Node b) {
    const auto [c, d] = carried(s, a, b);
    const double x = 1.0 / (s.longer[a] * s.longer[a]), y = 1.0 / (s.size[a] * s.size[a]);
    return {c * c * x + d * d * y, d * d * x + c * c * y, c * d * (y - x)};
}

/// The distance from a to b in the metric of a.
double metric_distance(const GradedSizes& s, Node a, Node b) {
    const Point3 d = s.point[b] - s.point[a];
    double along = dot(d, s.along[a]);
    const double left = std::max(d.x * d.x + d.y * d.y + d.z * d.z - along * along, 0.0);
    along /= s.longer[a];
    return std::sqrt(along * along + left / (s.size[a] * s.size[a]));
}

/// A way in the tangent plane of a node: squares of the cosine and sine of its angle to `along`.
struct Way {
    double along, left;
};

/// The direction of d at node n; nowhere where d is across the surface.
Way way_at(const GradedSizes& s, Node n, Point3 d) {
    const double along = squared(dot(d, s.along[n]));
    const double left = squared(dot(d, cross(s.normal[n], s.along[n])));
    const double sum = along + left;
    return sum > 0.0 ? Way{along / sum, left / sum} : Way{0.0, 0.0};
}

/// Raise x = 1 / longer^2 of b, or y = 1 / size^2 where the way from a goes across, not above
/// `most`, until the size along that way is no larger than what it grows to from that at a.
///
/// What turns and what grows add up there: each alone may be within its limits. Not both are
/// raised, which would spread round sizes over all that turns.
void hold_along(const GradedSizes& s, Node a, Node b, double most, double& x, double& y) {
    const Point3 d = s.point[b] - s.point[a];
    const Way from = way_at(s, a, d), to = way_at(s, b, d);
    const double inverse = from.along / squared(s.longer[a]) + from.left / squared(s.size[a]);
    if (inverse == 0.0) return;
    const double allowed = 1.0 / std::sqrt(inverse) + s.slope * std::sqrt(dot(d, d));
    const double least = std::min(1.0 / squared(allowed), most);
    const double by_longer = to.along * x, by_shorter = to.left * y;
    if (by_longer + by_shorter >= ENOUGH_ALONG * least) return;
    if (LONGER_FIRST * by_longer > by_shorter)
        x = std::max(x, std::min((least - by_shorter) / to.along, most));
    else
        y = std::max(y, std::min((least - by_longer) / to.left, most));
}

/// Lower the sizes of b until its metric contains that of a, grown over their distance.
///
/// Over the distance l, in the metric of a, the sizes in the directions of b may grow by
/// g = 1 + slope l, and so may the size along the way from a to b; as a whole, M_b - M_a / f^2 must be positive definite for the faster
/// f = 1 + TURN_SLOPE slope l. The first bounds both sizes of b; what is wanting in the second
/// is due to a direction that turns, and shortens the size along `along` alone, as long as
/// none smaller than the smallest of a, grown, is needed: principal directions stay what they
/// are, and the size along one may become the shorter. Returns the relative change of b.
double bind(const GradedSizes& s, Node a, Node b, std::int32_t sweep) {
    const double l = metric_distance(s, a, b);
    const double growth = 1.0 + s.slope * l;
    const double least = growth * std::min(s.size[a], s.longer[a]);
    const double hb = s.size[b], lb = s.longer[b];
    if (std::max(hb, lb) <= least) return 0.0;
    const Point3 n = s.normal[b];
    if (n.x == 0.0 && n.y == 0.0 && n.z == 0.0) {
        s.size[b] = std::min(hb, least);
        s.longer[b] = std::min(lb, least);
        s.changed[b] = sweep;
        return std::max(hb, lb) / least - 1.0;
    }
    const auto [mx, my, mxy] = carried_metric(s, a, b);
    const double f = 1.0 / squared(1.0 + TURN_SLOPE * s.slope * l);
    const double g = 1.0 / (growth * growth);
    double y = std::max(1.0 / (hb * hb), g * my);
    double x = std::max(1.0 / (lb * lb), g * mx);
    // no direction needs less than the smallest size of a, grown
    const double most = 1.0 / (least * least);
    double need = 0.0;
    if (y > f * my)  // not between two images of one point
        need = std::min(f * mx + squared(f * mxy) / (y - f * my), most);
    x = std::max(x, need);
    if (need == most)
        y = std::max(
            y, std::min(f * my + squared(f * mxy) / std::max(x - f * mx, 1e-12 * most), most));
    hold_along(s, a, b, most, x, y);
    if (x > y && !s.round.empty() && s.round[b] != 0) y = x;
    const double longer = std::min(1.0 / std::sqrt(x), lb);
    const double shorter = std::min(1.0 / std::sqrt(y), hb);
    const double change = std::max(lb / longer, hb / shorter) - 1.0;
    if (change <= ROUNDING) return 0.0;
    s.size[b] = shorter;
    s.longer[b] = longer;
    s.changed[b] = sweep;
    return change;
}

/// Let neither of a and b exceed what the other allows; returns the relative change.
double level(const GradedSizes& s, Node a, Node b, std::int32_t sweep) {
    if (s.longer.empty()) return limit(s, a, b, sweep);
    const double first = bind(s, a, b, sweep);
    return std::max(first, bind(s, b, a, sweep));
}

/// Neighbours in a patch: right, up and the two diagonals of each node of the 3 x 3.
struct NodePair {
    int a, b;
};
constexpr NodePair PAIRS[20] = {{0, 1}, {0, 3}, {0, 4}, {1, 3}, {1, 2}, {1, 4}, {1, 5},
                                {2, 4}, {2, 5}, {3, 4}, {3, 6}, {3, 7}, {4, 6}, {4, 5},
                                {4, 7}, {4, 8}, {5, 7}, {5, 8}, {6, 7}, {7, 8}};

/// Numbers of the pairs by their nodes, either way round.
constexpr std::array<std::array<int, 9>, 9> numbers_of_pairs() {
    std::array<std::array<int, 9>, 9> number{};
    for (int k = 0; k < 20; ++k) {
        number[PAIRS[k].a][PAIRS[k].b] = k;
        number[PAIRS[k].b][PAIRS[k].a] = k;
    }
    return number;
}
constexpr auto PAIR_OF = numbers_of_pairs();

/// A patch whose isotropic sizes are levelled apart from the others, and then put back.
///
/// Most pairs and triangles allow what they have. A bound that rounding cannot reach says so
/// without a root: SURE below one for pairs, and for triangles the area from the three squares
/// of sides with what it may be wrong by.
class PatchOfSizes {
  public:
    PatchOfSizes(const GradedSizes& s, const Patch& patch, std::int32_t sweep)
        : sizes_(s), patch_(patch), sweep_(sweep) {
        for (int i = 0; i < 9; ++i) {
            h_[i] = s.size[patch.node[i]];
            point_[i] = s.point[patch.node[i]];
        }
        for (int k = 0; k < 20; ++k) {
            const Point3 a = point_[PAIRS[k].a], b = point_[PAIRS[k].b];
            square_[k] = squared(a.x - b.x) + squared(a.y - b.y) + squared(a.z - b.z);
        }
    }

    /// Level all neighbours, then each corner of the four quarters with the two triangles that it
    /// sees them as; returns the largest relative change.
    ///
    ///      b --- o        of corner c: c a o and c o b
    ///      |  /  |
    ///      c --- a
    double level() {
        double largest = 0.0;
        for (int k = 0; k < 20; ++k) largest = std::max(largest, limit(k));
        constexpr int corners[4][4] = {{0, 1, 4, 3}, {1, 2, 5, 4}, {3, 4, 7, 6}, {4, 5, 8, 7}};
        for (const auto& quarter : corners)
            for (int i = 0; i < 4; ++i) {
                const int c = quarter[i], a = quarter[(i + 1) % 4];
                const int o = quarter[(i + 2) % 4], b = quarter[(i + 3) % 4];
                largest = std::max(largest, limit_across(c, a, o));
                largest = std::max(largest, limit_across(c, o, b));
            }
        return largest;
    }

  private:
    static constexpr double SURE = 1.0 - 1e-10, WRONG = 1e-12;

    double lower(int node, double size, double change) {
        h_[node] = size;
        sizes_.size[patch_.node[node]] = size;
        sizes_.changed[patch_.node[node]] = sweep_;
        return change;
    }

    /// As for two nodes apart, see there.
    double limit(int pair) {
        const auto [a, b] = PAIRS[pair];
        const double apart = h_[a] - h_[b], slope = sizes_.slope;
        if (apart * apart < SURE * (slope * slope * square_[pair])) return 0.0;
        if (apart == 0.0) return 0.0;
        const double rise = slope * std::sqrt(square_[pair]);
        if (h_[a] > h_[b] + rise) {
            const double change = apart - rise, size = h_[b] + rise;
            return lower(a, size, change / size);
        }
        if (h_[b] > h_[a] + rise) {
            const double change = h_[b] - h_[a] - rise, size = h_[a] + rise;
            return lower(b, size, change / size);
        }
        return 0.0;
    }

    /// Lower the size of c to what grows from the segment between a and b, sizes linear on it.
    ///
    /// The formula of Hopf and Lax on a flat triangle (Bornemann and Rasch 2006, section 3): with q
    /// and p the coordinates of c along ab and away from it, and k the rise along ab per length
    /// over the slope, the least of  h(x) + slope |c - x|  lies at  q - k p / sqrt(1 - k^2)  from
    /// a. Where that is beyond an end, the end decides, and `limit` has seen to it.
    double limit_across(int c, int a, int b) {
        const double ha = h_[a], hb = h_[b], hc = h_[c], slope = sizes_.slope;
        const double above = hc - std::min(ha, hb);
        if (above <= 0.0) return 0.0;
        const double square = square_[PAIR_OF[a][b]];
        if (is_level(above, square, square_[PAIR_OF[a][c]], square_[PAIR_OF[b][c]])) return 0.0;
        const Point3 ab = point_[b] - point_[a], ac = point_[c] - point_[a];
        const double onward = dot(ab, ac);
        const double area = dot(ac, ac) * square - onward * onward;  // p^2 l^2
        if (square == 0.0 || above * above * square <= slope * slope * area) return 0.0;
        const double l = std::sqrt(square), q = onward / l;
        const double k = (hb - ha) / (l * slope), free = 1.0 - k * k;
        if (free <= 0.0) return 0.0;
        const double root = std::sqrt(free), p = std::sqrt(std::max(area, 0.0)) / l;
        const double from_a = q - k * p / root;
        if (from_a <= 0.0 || from_a >= l) return 0.0;
        const double allowed = ha + slope * (k * q + p * root);
        if (hc <= allowed) return 0.0;
        const double change = (hc - allowed) / allowed;
        if (change <= ROUNDING) return 0.0;
        return lower(c, allowed, change);
    }

    /// Is a node surely no farther above the side ab of its triangle than the slope allows?
    [[nodiscard]] bool is_level(double above, double ab, double ac, double bc) const {
        const double onward = 0.5 * (ab + ac - bc), sum = ab + ac + bc;
        const double area = ac * ab - onward * onward - WRONG * (sum * sum);
        return above * above * ab < SURE * (sizes_.slope * sizes_.slope * area);
    }

    const GradedSizes& sizes_;
    const Patch& patch_;
    std::int32_t sweep_;
    double h_[9];
    Point3 point_[9];
    double square_[20];
};

/// Level the neighbours in a patch.
double level_patch(const GradedSizes& s, const Patch& patch, std::int32_t sweep) {
    if (s.longer.empty()) return PatchOfSizes(s, patch, sweep).level();
    double largest = 0.0;
    for (const auto [a, b] : PAIRS)
        largest = std::max(largest, level(s, patch.node[a], patch.node[b], sweep));
    return largest;
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

SweepsDone grade(std::span<const Patch> patches, std::span<const JoinedNodes> joined,
                 const GradedSizes& s, std::int32_t first, std::int32_t sweeps) {
    for (std::int32_t sweep = first; sweep < first + sweeps; ++sweep) {
        double largest = 0.0;
        for (const Patch& patch : patches) {
            std::int32_t latest = 0;
            for (const Node n : patch.node) latest = std::max(latest, s.changed[n]);
            if (latest < sweep - 1) continue;
            largest = std::max(largest, level_patch(s, patch, sweep));
        }
        for (const auto [a, b] : joined) largest = std::max(largest, level(s, a, b, sweep));
        // nothing is newer than the sweep before the next
        if (largest < FINISHED_BELOW) return {sweep + 2, true};
    }
    return {first + sweeps, false};
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
