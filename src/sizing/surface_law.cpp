#include "sizing/surface_law.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "values/threads.hpp"

namespace surfmesh {
namespace {

constexpr std::size_t PLACES_TOGETHER = 1024;  // places that are read at a time

}  // namespace

SizeTensor root_of_form(const FundamentalForms& forms, const ChartPoint& at) {
    const auto [rates, crossed] = std::pair(at.rates, at.crossed);
    double e = forms.E * rates.x * rates.x, f = forms.F * rates.x * rates.y;
    double g = forms.G * rates.y * rates.y;
    if (at.is_crossed()) {  // the squares and the product of r_x and r_y
        e += 2.0 * forms.F * rates.x * crossed.y + forms.G * crossed.y * crossed.y;
        f += forms.E * rates.x * crossed.x + forms.F * crossed.x * crossed.y +
             forms.G * crossed.y * rates.y;
        g += 2.0 * forms.F * rates.y * crossed.x + forms.E * crossed.x * crossed.x;
    }
    const double s = std::sqrt(most(e * g - f * f, 0.0));
    const double t = std::sqrt(most(e + g + 2.0 * s, std::numeric_limits<double>::min()));
    return {(e + s) / t, f / t, (g + s) / t};
}

SurfaceLaw::SurfaceLaw(const Surface& surface, Chart chart, SizeRules rules,
                       std::optional<Rims> rims, OuterLimits outer)
    : surface_(surface),
      chart_(std::move(chart)),
      rules_(std::move(rules)),
      rims_(std::move(rims)),
      outer_(std::move(outer)) {}

std::exception_ptr SurfaceLaw::take_failure() {
    if (status_ == SurfaceStatus::FAILED)
        if (const std::exception_ptr failure = surface_.take_failure()) return failure;
    return rules_.take_failure();
}

bool SurfaceLaw::ask(std::span<const Point2> xy, FieldNodes& nodes) {
    const std::size_t count = xy.size();
    nodes.size.resize(count, rules_.largest);
    nodes.target_size.resize(count);
    nodes.root.resize(count);
    nodes.normal.resize(count);
    nodes.point.resize(count);
    Places places{Array<PrincipalCurvatures>(count), Array<std::uint8_t>(count)};
    for_each_block(count, PLACES_TOGETHER, [&](std::size_t first, std::size_t last) {
        read(xy.subspan(first, last - first), first, nodes, places);
    });
    if (status_ != SurfaceStatus::DONE || !lower_by_rules(places, nodes)) return false;
    for_each_block(count, PLACES_TOGETHER, [&](std::size_t first, std::size_t last) {
        if (rims_) lower_at_rims(xy.subspan(first, last - first), first, nodes);
        bound(first, last, nodes);
    });
    return status_ == SurfaceStatus::DONE;
}

/// The surface at some places: what is stored of it, and what rules are asked with.
void SurfaceLaw::read(std::span<const Point2> xy, std::size_t first, FieldNodes& nodes,
                      Places& places) {
    Array<Point2> uv(xy.size());
    Array<ChartPoint> at(xy.size());
    for (std::size_t i = 0; i < xy.size(); ++i) {
        at[i] = chart_.at(xy[i]);
        uv[i] = at[i].uv;
    }
    SurfaceValues r;
    const SurfaceStatus status = r.evaluate(surface_, {uv.data(), uv.size()}, 2);
    if (status != SurfaceStatus::DONE) {
        status_.store(status);
        return;
    }
    for (std::size_t i = 0; i < xy.size(); ++i) {
        const FundamentalForms forms =
            fundamental_forms(r[1][i], r[2][i], {r[3][i], r[4][i], r[5][i]});
        const std::size_t node = first + i;
        places.curvature[node] = principal_curvatures(forms);
        places.degenerate[node] = forms.degenerate ? 1 : 0;
        nodes.root[node] = root_of_form(forms, at[i]);
        nodes.normal[node] = forms.normal;
        nodes.point[node] = r[0][i];
    }
}

/// Lower sizes to what each rule allows. The caller's own are asked here, by one thread.
bool SurfaceLaw::lower_by_rules(const Places& places, FieldNodes& nodes) const {
    const std::size_t count = nodes.size.size();
    Array<double> own(count);
    const std::span<double> out{own.data(), count};
    for (const auto& rule : rules_.by_curvature) {
        if (!rule->sizes({places.curvature.data(), count}, out)) return false;
        for (std::size_t i = 0; i < count; ++i)
            // nothing is known at a pole or a cusp: gradation brings the neighbours' size
            if (places.degenerate[i] == 0) nodes.size[i] = least(nodes.size[i], own[i]);
    }
    for (const auto& rule : rules_.by_place) {
        if (!rule->sizes({nodes.point.data(), count}, out)) return false;
        for (std::size_t i = 0; i < count; ++i) nodes.size[i] = least(nodes.size[i], own[i]);
    }
    return true;
}

/// Is a place of the chart on a side, numbered as Python's ``sides``?
bool SurfaceLaw::is_on_side(Point2 xy, std::size_t side) const {
    const Point2 end = chart_.extent();
    const bool on_it[] = {xy.y == 0.0, xy.x == end.x, xy.y == end.y, xy.x == 0.0};
    return on_it[side];
}

/// Lower sizes on open sides, and near trimming loops, to what the curvature there allows.
void SurfaceLaw::lower_at_rims(std::span<const Point2> xy, std::size_t first, FieldNodes& nodes) {
    for (std::size_t side = 0; side < 4; ++side)
        if (rims_->open_sides[side])
            at_side(side, xy, [&](std::size_t i, const RimSize& rim) {
                nodes.size[first + i] = least(nodes.size[first + i], rim.size);
            });
    if (rims_->loops == nullptr) return;
    for (std::size_t i = first; i < first + xy.size(); ++i)
        nodes.size[i] = least(nodes.size[i], rims_->loops->at(nodes.point[i]));
}

/// Keep sizes within the bounds, and then within limits of edges or of earlier rounds.
void SurfaceLaw::bound(std::size_t first, std::size_t last, FieldNodes& nodes) const {
    for (std::size_t i = first; i < last; ++i) {
        double& size = nodes.size[i];
        size = nodes.target_size[i] = most(size, rules_.smallest);
        if (outer_.limits == nullptr) continue;
        size = least(size, most(outer_.limits->at(nodes.point[i]), outer_.least));
        if (outer_.are_targets) nodes.target_size[i] = size;
    }
}

}  // namespace surfmesh
