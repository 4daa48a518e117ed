#include "sizing/stretched_law.hpp"

#include <algorithm>
#include <limits>

#include "values/threads.hpp"

namespace surfmesh {
namespace {

constexpr std::size_t STRETCHED_TOGETHER = 1024;  // places that are read at a time

// How much more than the reached ratio of the two sizes the shorter one leaves room for.
constexpr double REACHED = 1.1;

template <class T>
std::span<T> all(Array<T>& array) {
    return {array.data(), array.size()};
}

template <class T>
std::span<const T> all(const Array<T>& array) {
    return {array.data(), array.size()};
}

/// Do two sizes, the shorter one first, differ by so much that their directions matter?
bool is_stretched(NumberPair asked) { return asked.second > ROUND * asked.first; }

/// The shorter of two sizes that the rules allow at some curvatures, for ratios of the two at most.
bool shorter_of_principal(const SizeRules& rules, std::span<const PrincipalCurvatures> k,
                          std::span<const double> ratio, std::span<double> out) {
    Array<PrincipalSizes> both(k.size());
    if (!rules.principal(k, ratio, all(both))) return false;
    for (std::size_t i = 0; i < k.size(); ++i) out[i] = least(both[i].first, both[i].second);
    return true;
}

}  // namespace

bool StretchedLaw::ask(std::span<const Point2> xy, FieldNodes& nodes) {
    const std::size_t count = xy.size();
    nodes.root.resize(count);
    nodes.normal.resize(count);
    nodes.point.resize(count);
    nodes.jacobian.resize(count);
    nodes.along.resize(count);
    Places places{Array<Point2>(count), Array<PrincipalDirections>(count),
                  Array<PrincipalCurvatures>(count), Array<std::uint8_t>(count),
                  Array<std::uint8_t>(count)};
    Array<PlaceTangents> tangents(count);
    for_each_block(count, STRETCHED_TOGETHER, [&](std::size_t first, std::size_t last) {
        read(xy.subspan(first, last - first), first, nodes, places, all(tangents));
    });
    Array<TwoSizes> found(count);
    if (status_ != SurfaceStatus::DONE || !ask_rules(nodes, all(tangents), places, all(found)))
        return false;
    nodes.size.resize(count);
    nodes.target_size.resize(count);
    nodes.longer.resize(count);
    nodes.longer_target.resize(count);
    nodes.asked.resize(count);
    nodes.curvature.resize(count);
    nodes.turn_rates.resize(count);
    for_each_block(count, STRETCHED_TOGETHER, [&](std::size_t first, std::size_t last) {
        const std::span<TwoSizes> own = all(found).subspan(first, last - first);
        if (rims_) lower_at_rims(xy.subspan(first, own.size()), first, nodes, own);
        fill(first, places, own, nodes);
    });
    return status_ == SurfaceStatus::DONE;
}

/// The surface at some places: what is stored of it, and what rules are asked with.
void StretchedLaw::read(std::span<const Point2> xy, std::size_t first, FieldNodes& nodes,
                        Places& places, std::span<PlaceTangents> tangents) {
    Array<ChartPoint> at(xy.size());
    for (std::size_t i = 0; i < xy.size(); ++i) {
        at[i] = chart_.at(xy[i]);
        places.uv[first + i] = at[i].uv;
    }
    SurfaceValues r;
    const SurfaceStatus status = r.evaluate(surface_, {&places.uv[first], xy.size()}, 2);
    if (status != SurfaceStatus::DONE) {
        status_.store(status);
        return;
    }
    for (std::size_t i = 0; i < xy.size(); ++i) {
        const Point3 ru = r[1][i], rv = r[2][i];
        const FundamentalForms forms = fundamental_forms(ru, rv, {r[3][i], r[4][i], r[5][i]});
        const std::size_t node = first + i;
        places.principal[node] = principal_directions(forms);
        places.curvature[node] = places.principal[node].k;
        places.degenerate[node] = forms.degenerate ? 1 : 0;
        tangents[node] = {ru, rv};
        nodes.root[node] = root_of_form(forms, at[i]);
        nodes.normal[node] = forms.normal;
        nodes.point[node] = r[0][i];
        const Point3 rx = at[i].by_x(ru, rv), ry = at[i].by_y(ru, rv);
        nodes.jacobian[node] = {{{rx.x, ry.x}, {rx.y, ry.y}, {rx.z, ry.z}}};
    }
}

/// What the rules allow but those of rims; the caller's own are asked here, by one thread.
bool StretchedLaw::ask_rules(const FieldNodes& nodes, std::span<const PlaceTangents> tangents,
                             Places& places, std::span<TwoSizes> found) const {
    const std::size_t count = found.size();
    Array<PrincipalSizes> sizes(count);
    Array<double> by_place(count);
    if (!rules_.principal(all(places.curvature), {&rules_.anisotropy, 1}, all(sizes))) return false;
    if (!rules_.from_place(all(nodes.point), all(by_place))) return false;
    for (std::size_t i = 0; i < count; ++i) {
        auto [first, second] = sizes[i];
        const bool along_first = first > second;
        places.along_first[i] = along_first ? 1 : 0;
        const PrincipalDirections& k = places.principal[i];
        const Point2 d = along_first ? k.d1 : k.d2;
        Point3 along = d.x * tangents[i].ru + d.y * tangents[i].rv;
        if (places.degenerate[i] != 0) {
            along = {1.0, 0.0, 0.0};
            first = second = rules_.largest;
        }
        const double length = norm(along);
        along = {along.x / length, along.y / length, along.z / length};
        const double highest = most(by_place[i], rules_.smallest);  // holds in every direction
        first = least(first, highest);
        second = least(second, highest);
        found[i] = {nodes.normal[i], along, least(first, second), most(first, second),
                    rules_.anisotropy};
    }
    return true;
}

/// Lower sizes on open sides, and near trimming loops, to what the curvature there allows.
void StretchedLaw::lower_at_rims(std::span<const Point2> xy, std::size_t first,
                                 const FieldNodes& nodes, std::span<TwoSizes> found) {
    for (std::size_t side = 0; side < 4; ++side)
        if (rims_->open_sides[side])
            at_side(side, xy, [&](std::size_t i, const RimSize& rim) {
                found[i].lower_to_rim(rim, rules_.smallest);
            });
    if (rims_->loops == nullptr) return;
    for (std::size_t i = 0; i < found.size(); ++i)
        found[i].lower_to(SizeLimits::Here(*rims_->loops, nodes.point[first + i]), rules_.smallest);
}

/// Nodes of these sizes within outer limits, and how fast their directions turn.
void StretchedLaw::fill(std::size_t first, const Places& places, std::span<const TwoSizes> found,
                        FieldNodes& nodes) {
    for (std::size_t i = 0; i < found.size(); ++i) {
        const std::size_t node = first + i;
        const TwoSizes& own = found[i];
        TwoSizes held = own;
        if (outer_.limits != nullptr)
            held = own.limited(SizeLimits::Here(*outer_.limits, nodes.point[node]), outer_.least);
        const TwoSizes& target = outer_.limits != nullptr && outer_.are_targets ? held : own;
        nodes.size[node] = held.size;
        nodes.target_size[node] = target.size;
        nodes.longer[node] = held.longer;
        nodes.longer_target[node] = target.longer;
        nodes.along[node] = held.along;
        nodes.asked[node] = {held.size, held.longer};
        nodes.curvature[node] = {places.curvature[node].k1, places.curvature[node].k2};
        nodes.turn_rates[node] = {0.0, 0.0};
    }
    if (!even_) find_turn_rates(first, found.size(), places, nodes);
}

/// How fast the directions of nodes turn, where that can matter: see ``longest_at``.
void StretchedLaw::find_turn_rates(std::size_t first, std::size_t count, const Places& places,
                                   FieldNodes& nodes) {
    Array<std::size_t> stretched;
    Array<RatePlace> rate_places;
    for (std::size_t node = first; node < first + count; ++node) {
        if (!is_stretched(nodes.asked[node])) continue;
        stretched.push_back(node);
        rate_places.push_back({places.uv[node], places.principal[node],
                               places.along_first[node] != 0, nodes.size[node]});
    }
    if (stretched.empty()) return;
    Array<NumberPair> rates(stretched.size());
    const SurfaceStatus status = direction_rates(surface_, all(rate_places), all(rates));
    if (status != SurfaceStatus::DONE) status_.store(status);
    for (std::size_t i = 0; i < stretched.size(); ++i) nodes.turn_rates[stretched[i]] = rates[i];
}

bool StretchedLaw::regained(const FieldNodes& nodes, std::span<const double> ratio,
                            std::span<double> size) const {
    const std::size_t count = nodes.count();
    Array<PrincipalCurvatures> k;
    k.reserve(count);
    for (const NumberPair& pair : nodes.curvature) k.push_back({pair.first, pair.second});
    Array<double> asked(count);
    if (!shorter_of_principal(rules_, all(k), {&rules_.anisotropy, 1}, all(asked))) return false;
    if (!shorter_of_principal(rules_, all(k), ratio, size)) return false;
    for (std::size_t n = 0; n < count; ++n) {
        const double own = nodes.asked[n].first;
        size[n] = own >= asked[n] ? most(own, size[n]) : own;  // untouched by laws and limits
    }
    return true;
}

double longest_at(const FieldNodes& nodes, std::ptrdiff_t node, double size, double chord) {
    if (!is_stretched(nodes.asked[node])) return std::numeric_limits<double>::infinity();
    const auto [k1, k2] = nodes.curvature[node];
    return longest_along(nodes.turn_rates[node], {k1, k2}, size, chord);
}

FieldOutcome limit_longer_sizes(FieldBuilder& builder, const StretchedLaw& law, double chord) {
    FieldNodes& nodes = builder.nodes;
    const std::size_t count = nodes.count();
    Array<double> width(count), longer(count), ratio(count);
    for (std::size_t n = 0; n < count; ++n) width[n] = nodes.asked[n].first;
    builder.touch_all();
    if (const FieldOutcome done = builder.spread(all(width)); done.status != FieldStatus::done)
        return done;
    for (std::size_t n = 0; n < count; ++n) {  // what is graded already grows from few of them
        longer[n] = least(nodes.asked[n].second, longest_at(nodes, n, width[n], chord));
        if (!(longer[n] < nodes.longer[n])) continue;
        nodes.longer[n] = longer[n];
        builder.touch(static_cast<Node>(n));
    }
    if (const FieldOutcome done = builder.grade_nodes(); done.status != FieldStatus::done)
        return done;
    for (std::size_t n = 0; n < count; ++n) ratio[n] = REACHED * nodes.longer[n] / nodes.size[n];
    Array<double> size(count);
    if (!law.regained(nodes, all(ratio), all(size))) return {FieldStatus::failed, {0.0, 0.0}, 0.0};
    for (std::size_t n = 0; n < count; ++n) {
        longer[n] = least(longer[n], ratio[n] * size[n]);
        if (size[n] == nodes.size[n] && longer[n] == nodes.longer[n]) continue;  // graded as it is
        nodes.size[n] = size[n];
        nodes.longer[n] = longer[n];
        builder.touch(static_cast<Node>(n));
    }
    return builder.grade_nodes();
}

}  // namespace surfmesh
