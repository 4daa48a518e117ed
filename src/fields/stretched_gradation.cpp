#include "fields/stretched_gradation.hpp"

#include <algorithm>
#include <cmath>

namespace surfmesh {
namespace {

// How much rather the longer size is lowered than the shorter one, by what either contributes.
constexpr double LONGER_FIRST = 16.0;

// Of the square that a way is to be long in the metric: what is let pass, as turning metrics creep
// towards the rest in many visits.
constexpr double ENOUGH_ALONG = 0.98;

double square_of(double x) { return x * x; }

bool is_zero(Point3 n) { return n.x == 0.0 && n.y == 0.0 && n.z == 0.0; }

/// The direction ``along`` of a in the axes of b, times 1 + |c| for the cosine c between the normals.
///
/// Turned with the normal by the smallest rotation. Normals may be opposite across a joint.
Point2 carried_axis(const StretchedNode& a, const StretchedNode& b) {
    const double c = dot(a.normal, b.normal), sign = c >= 0.0 ? 1.0 : -1.0;
    const Point3 turned = (1.0 + std::abs(c)) * a.along -
                          sign * dot(a.along, b.normal) * (a.normal + sign * b.normal);
    return {dot(turned, b.along), dot(turned, b.left)};
}

/// The way from one node to another, and its squares in the axes of the first.
struct Way {
    Point3 step;
    double onward;          // squared, along
    double grown, turning;  // squares of the factors on sizes and on the metric as a whole
};

/// Does the metric of b surely contain that of a, grown by the squares of both factors, so that
/// ``bind`` would change nothing?
///
/// The same questions without divisions, each with a margin that rounding does not reach.
bool surely_allows(const StretchedNode& a, const StretchedNode& b, const Way& way, double slope) {
    constexpr double SURE = 1.0 - 1e-10, SPARE = 1e-4;
    const Point2 axis = carried_axis(a, b);
    const double xx = axis.x * axis.x, yy = axis.y * axis.y, square = xx + yy;
    if (!(square > 0.0)) return false;
    const double of_along = xx * a.by_longer + yy * a.by_shorter;  // times the square
    const double of_left = yy * a.by_longer + xx * a.by_shorter;
    const double along = SURE * square * b.by_longer, left = SURE * square * b.by_shorter;
    if (!(of_along <= along * way.grown && of_left <= left * way.grown)) return false;
    const double spare_along = along * way.turning - of_along;
    const double spare_left = left * way.turning - of_left;
    // with digits left for their product
    if (!(spare_along > SPARE * along && spare_left > SPARE * left)) return false;
    const double mixed = axis.x * axis.y * (a.by_shorter - a.by_longer);
    if (!(mixed * mixed <= SURE * (spare_along * spare_left))) return false;
    const double aside = square_of(dot(way.step, a.left)), across = way.onward + aside;
    const double by_along = square_of(dot(way.step, b.along));
    const double by_left = square_of(dot(way.step, b.left));
    const double square_of_a = way.onward * a.by_longer + aside * a.by_shorter;
    const double of_b = (by_along * b.by_longer + by_left * b.by_shorter) * across * SURE;
    const double of_a = square_of_a * (by_along + by_left);
    if (of_b >= of_a) return true;  // no larger along the way than at a
    const double longer_way = 1.0 + slope * std::sqrt(square_of_a);
    return of_b * (longer_way * longer_way) >= ENOUGH_ALONG * of_a;
}

}  // namespace

StretchedGradation::StretchedGradation(const GradedSizes& sizes, const NodeNeighbours& neighbours,
                                       std::int32_t number)
    : s_(sizes), neighbours_(neighbours), number_(number), place_(sizes.size.size(), NIL) {
    nodes_.reserve(s_.size.size());
}

/// A node with what is worked out of it: a gradation of few new nodes visits few.
StretchedNode& StretchedGradation::node(Node n) {
    if (place_[n] == NIL) {
        place_[n] = static_cast<std::int32_t>(nodes_.size());
        const double h = s_.size[n], longer = s_.longer[n];
        nodes_.push_back({s_.point[n], s_.normal[n], s_.along[n], cross(s_.normal[n], s_.along[n]),
                          longer, h, 1.0 / (longer * longer), 1.0 / (h * h)});
    }
    return nodes_[place_[n]];
}

void StretchedGradation::visit(Node p, SizeQueue& queue) {
    neighbours_.collect(p, around_);
    const bool is_new = s_.changed[p] >= number_;
    const StretchedNode& from = node(p);
    for (const Node n : around_) {
        if (!is_new && s_.changed[n] < number_) continue;  // graded in an earlier round
        StretchedNode& to = node(n);
        const double change = bind(from, to, !s_.round.empty() && s_.round[n] != 0);
        if (change == 0.0) continue;
        s_.size[n] = to.size;
        s_.longer[n] = to.longer;
        s_.changed[n] = number_;
        queue.lowered(n, key(n), change);
    }
}

/// The metric of a in the axes of b.
StretchedGradation::AxisMetric StretchedGradation::carried(const StretchedNode& a,
                                                           const StretchedNode& b) {
    const auto [x, y] = carried_axis(a, b);
    const double square = x * x + y * y;
    if (square == 0.0) return {a.by_longer, a.by_shorter, 0.0};
    const double by_along = x * x / square, by_left = y * y / square;
    return {by_along * a.by_longer + by_left * a.by_shorter,
            by_left * a.by_longer + by_along * a.by_shorter,
            (x * y / square) * (a.by_shorter - a.by_longer)};
}

/// Raise the metric of b along, or left where the way from a goes across, not above `most`, until
/// the size along that way is no larger than what it grows to from that at a.
///
/// What turns and what grows add up there: each alone may be within its limits. Not both are
/// raised, which would spread round sizes over all that turns.
void StretchedGradation::hold_along(const StretchedNode& a, const StretchedNode& b, double most,
                                    AxisMetric& m) const {
    const Point3 step = b.point - a.point;
    const double onward = square_of(dot(step, a.along)), aside = square_of(dot(step, a.left));
    double along = square_of(dot(step, b.along)), left = square_of(dot(step, b.left));
    const double across = onward + aside, sum = along + left;
    if (!(across > 0.0 && sum > 0.0)) return;  // the way leads off the surface
    const double square = onward * a.by_longer + aside * a.by_shorter;
    if ((along * m.along + left * m.left) * across >= square * sum) return;  // no larger than at a
    along /= sum;
    left /= sum;
    // 1 / (h + slope |step|)^2 with h^-2 = inverse
    const double inverse = square / across;
    const double grown = 1.0 + s_.slope * std::sqrt(inverse * dot(step, step));
    const double least = std::min(inverse / (grown * grown), most);
    const double by_longer = along * m.along, by_shorter = left * m.left;
    if (by_longer + by_shorter >= ENOUGH_ALONG * least) return;
    if (LONGER_FIRST * by_longer > by_shorter)
        m.along = std::max(m.along, std::min((least - by_shorter) / along, most));
    else
        m.left = std::max(m.left, std::min((least - by_longer) / left, most));
}

/// Lower the sizes of b until its metric contains that of a, grown over their distance.
///
/// Over the distance l, in the metric of a, the sizes in the directions of b may grow by
/// g = 1 + slope l, and so may the size along the way from a to b; as a whole, M_b - M_a / f^2
/// must be positive definite for the faster f = 1 + TURN_SLOPE slope l. The first bounds both
/// sizes of b; what is wanting in the second is due to a direction that turns, and shortens the
/// size along `along` alone, as long as none smaller than the smallest of a, grown, is needed:
/// principal directions stay what they are, and the size along one may become the shorter. Returns
/// the relative change of b.
double StretchedGradation::bind(const StretchedNode& a, StretchedNode& b, bool is_round) const {
    const double hb = b.size, lb = b.longer, longest = std::max(hb, lb);
    const double least_of_a = std::min(a.size, a.longer);
    if (longest <= least_of_a) return 0.0;
    const Point3 step = b.point - a.point;
    const double onward = square_of(dot(step, a.along));
    const double aside = std::max(dot(step, step) - onward, 0.0);
    const double l = std::sqrt(onward * a.by_longer + aside * a.by_shorter);
    const double growth = 1.0 + s_.slope * l, least = growth * least_of_a;
    if (longest <= least) return 0.0;
    if (is_zero(b.normal)) {
        set(b, std::min(hb, least), std::min(lb, least));
        return longest / least - 1.0;
    }
    const double turning = 1.0 + TURN_SLOPE * s_.slope * l;
    if (!(is_round && b.by_longer > b.by_shorter) &&
        surely_allows(a, b, {step, onward, growth * growth, turning * turning}, s_.slope))
        return 0.0;
    const AxisMetric of_a = carried(a, b);
    const double f = 1.0 / square_of(turning), g = 1.0 / (growth * growth);
    AxisMetric m{std::max(b.by_longer, g * of_a.along), std::max(b.by_shorter, g * of_a.left), 0.0};
    // no direction needs less than the smallest size of a, grown
    const double most = 1.0 / (least * least), mixed = square_of(f * of_a.mixed);
    double need = 0.0;
    if (m.left > f * of_a.left)  // not between two images of one point
        need = std::min(f * of_a.along + mixed / (m.left - f * of_a.left), most);
    m.along = std::max(m.along, need);
    if (need == most) {
        const double over = std::max(m.along - f * of_a.along, 1e-12 * most);
        m.left = std::max(m.left, std::min(f * of_a.left + mixed / over, most));
    }
    hold_along(a, b, most, m);
    if (m.along > m.left && is_round) m.left = m.along;
    if (m.along == b.by_longer && m.left == b.by_shorter) return 0.0;
    const double longer = std::min(1.0 / std::sqrt(m.along), lb);
    const double shorter = std::min(1.0 / std::sqrt(m.left), hb);
    const double change = std::max(lb / longer, hb / shorter) - 1.0;
    if (change <= ROUNDING) return 0.0;
    set(b, shorter, longer);
    return change;
}

void StretchedGradation::set(StretchedNode& node, double size, double longer) {
    node.size = size;
    node.longer = longer;
    node.by_shorter = 1.0 / (size * size);
    node.by_longer = 1.0 / (longer * longer);
}

}  // namespace surfmesh
