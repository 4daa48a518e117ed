#include "sizing/direction_rates.hpp"

#include <cmath>
#include <limits>

#include "sizing/curvature_sizes.hpp"

namespace surfmesh {
namespace {

// K y^2 in terms of ``chord`` where it decides: an eighth of it is used.
constexpr double SAG = 6.0, DECIDED = 3.0;

// In shorter sizes: the way over which curvatures are compared.
constexpr double STEP = 0.02;

constexpr double INFINITE = std::numeric_limits<double>::infinity();

/// The larger and the smaller of two numbers, or the one that is a number.
double larger(double a, double b) { return a >= b || b != b ? a : b; }
double smaller(double a, double b) { return a <= b || b != b ? a : b; }

/// Where curvatures are compared with those of a place, a way off along principal direction
/// ``axis``.
struct Neighbour {
    Point2 uv;
    bool is_inside;
};

Neighbour neighbour(const RatePlace& place, const ParameterBox& domain, int axis, double way) {
    const Point2 d = axis == 0 ? place.principal.d1 : place.principal.d2;
    const double step = way * (STEP * place.size);
    const Point2 there{place.uv.x + step * d.x, place.uv.y + step * d.y};
    const bool inside = there.x >= domain.low.x && there.x <= domain.high.x &&
                        there.y >= domain.low.y && there.y <= domain.high.y;
    return {{least(most(there.x, domain.low.x), domain.high.x),
             least(most(there.y, domain.low.y), domain.high.y)},
            inside};
}

double component(PrincipalCurvatures k, int axis) { return axis == 0 ? k.k1 : k.k2; }

}  // namespace

SurfaceStatus direction_rates(const Surface& surface, std::span<const RatePlace> places,
                              std::span<NumberPair> rates) {
    const ParameterBox domain = surface.domain();
    Array<Point2> uv(places.size());
    Array<std::uint8_t> inside(places.size());
    SurfaceValues r;
    for (NumberPair& rate : rates) rate = {INFINITE, INFINITE};
    for (const bool fans : {true, false})
        for (const double way : {1.0, -1.0}) {  // a node may lie on a knot, where curvatures jump
            for (std::size_t i = 0; i < places.size(); ++i) {
                const int axis = places[i].along_first == fans ? 0 : 1;
                const Neighbour found = neighbour(places[i], domain, axis, way);
                uv[i] = found.uv;
                inside[i] = found.is_inside ? 1 : 0;
            }
            const SurfaceStatus status = r.evaluate(surface, uv, 2);
            if (status != SurfaceStatus::DONE) return status;
            for (std::size_t i = 0; i < places.size(); ++i) {
                if (inside[i] == 0) continue;
                const FundamentalForms forms =
                    fundamental_forms(r[1][i], r[2][i], {r[3][i], r[4][i], r[5][i]});
                if (forms.degenerate) continue;
                const int changing = places[i].along_first == fans ? 1 : 0;
                const double here = component(places[i].principal.k, changing);
                const double there = component(principal_curvatures(forms), changing);
                double& rate = fans ? rates[i].first : rates[i].second;
                rate = smaller(rate, std::abs(there - here) / (STEP * places[i].size));
            }
        }
    for (NumberPair& rate : rates) {
        if (!std::isfinite(rate.first)) rate.first = 0.0;
        if (!std::isfinite(rate.second)) rate.second = 0.0;
    }
    return SurfaceStatus::DONE;
}

double longest_along(NumberPair rates, PrincipalCurvatures k, double size, double chord) {
    const double square = size * size;
    double sag = most(std::abs(k.k1), std::abs(k.k2)) * square;
    const double decided = larger(DECIDED * chord / sag, 1.0), spare = decided * decided;
    sag = most(sag, SAG * chord) * spare;
    double bound = smaller(FANNING * sag / (rates.first * square),
                           std::sqrt(BENDING * sag / (rates.second * size)));
    if (std::isnan(bound) || size <= 2.0 * chord) bound = INFINITE;  // it is within chord
    return larger(bound, size);
}

}  // namespace surfmesh
