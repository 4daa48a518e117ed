#include "surfaces/knot_places.hpp"

#include <algorithm>

namespace surfmesh {
namespace {

constexpr double LEAST_OF_SPAN = 0x1p-8;  // parts no narrower: third differences would be round-off
constexpr double NEAR_CREASE = 1e-12;     // of the knots' range: as near as split_at_knots says

/// How often the knot at the end of a part's span is there.
std::size_t times_at_end(const SplineBasis& basis, const SpanPart& part) {
    const auto knots = basis.knots();
    const double knot = knots[static_cast<std::size_t>(part.span) + 1];
    return static_cast<std::size_t>(std::count(knots.begin(), knots.end(), knot));
}

/// From the parameter to the farther end of the span.
void take(PlacesAtParameter& found, const SplineBasis& basis, std::int64_t span, double t) {
    const auto at = static_cast<std::size_t>(span);
    const double low = basis.knots()[at], high = basis.knots()[at + 1];
    const bool is_late = t - low > high - t;
    found.part[found.count] = {span, is_late ? low : t, is_late ? t : high, 0.0, false};
    found.from_last[found.count++] = is_late;
}

}  // namespace

SpanPart with_width(const SplineBasis& basis, SpanPart part) {
    const double low = basis.knots()[static_cast<std::size_t>(part.span)],
                 high = basis.knots()[static_cast<std::size_t>(part.span) + 1];
    const double least = LEAST_OF_SPAN * (high - low);
    if (part.last - part.first >= least) return part;
    if (part.first + least <= high)
        part.last = part.first + least;
    else
        part.first = part.last - least;
    return part;
}

bool jumps_before(const SplineBasis& basis, const Array<SpanPart>& parts,
                  Array<std::uint8_t>& jumps) {
    jumps.clear();
    const std::span all(parts.data(), parts.size());
    for (std::size_t n = 0; n < all.size(); ++n) {
        if (all[n].after_crease) return false;
        jumps.push_back(n > 0 && times_at_end(basis, all[n - 1]) + 1 >= basis.degree() ? 1 : 0);
    }
    return true;
}

PlacesAtParameter places_at(const SplineBasis& basis, double t, Interval domain) {
    PlacesAtParameter found;
    const KnotPlace place = basis.locate(t);
    take(found, basis, place.span, place.t);
    const auto knots = basis.knots();
    const std::size_t degree = basis.degree(), end = knots.size() - degree - 1;
    const double near = NEAR_CREASE * (knots[end] - knots[degree]);
    if (t - domain.lo <= near || domain.hi - t <= near) return found;
    const auto span = static_cast<std::size_t>(place.span);
    const double low = knots[span], high = knots[span + 1];
    const bool at_low = place.t - low <= near, at_high = high - place.t <= near;
    const double knot = at_low ? low : high;
    const bool at_end = knot == knots[degree] || knot == knots[end];
    const auto times = static_cast<std::size_t>(std::count(knots.begin(), knots.end(), knot));
    if (!(at_low || at_high) || (times < degree && !at_end)) return found;
    if (at_end && !(basis.period() > 0.0)) return found;
    std::size_t other = at_low ? span : span + 1;
    double there = place.t;
    if (at_end) {
        other = at_low ? end : degree;
        there += at_low ? basis.period() : -basis.period();
    }
    if (at_low)
        for (--other; other > degree && knots[other] == knots[other + 1];) --other;
    else
        while (other + 2 < end && knots[other] == knots[other + 1]) ++other;
    take(found, basis, static_cast<std::int64_t>(other), there);
    return found;
}

}  // namespace surfmesh
