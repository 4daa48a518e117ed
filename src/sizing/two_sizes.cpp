#include "sizing/two_sizes.hpp"

#include <cmath>
#include <limits>

#include "sizing/curvature_sizes.hpp"
#include "surfaces/fundamental_forms.hpp"

namespace surfmesh {
namespace {

bool is_zero(Point3 n) { return n.x == 0.0 && n.y == 0.0 && n.z == 0.0; }

double square(double x) { return x * x; }

double finite_or_zero(double x) { return std::isfinite(x) ? x : 0.0; }

double within(double x, double low, double high) { return surfmesh::least(most(x, low), high); }

/// A size that holds along a rim only, as limits are asked.
struct RimLimits {
    RimSize rim;

    [[nodiscard]] double along(Point3 direction) const {
        const double cosine = std::abs(lane_dot(direction, rim.tangent));
        return rim.size / most(cosine, std::numeric_limits<double>::epsilon());
    }
    [[nodiscard]] SizeLimits::Tightest tightest(Point3 /*normal*/) const {
        return {rim.size, rim.tangent};
    }
};

template <class Limits>
TwoSizes within_limits(const TwoSizes& t, const Limits& limits, double least) {
    TwoSizes found = t;
    const double across = most(limits.along(cross(t.normal, t.along)), least);
    const double onward = most(limits.along(t.along), least);
    const double factor = surfmesh::least(across, t.size) / t.size;
    found.longer = surfmesh::least(factor * t.longer, onward);
    found.size = surfmesh::least(factor * t.size, found.longer);
    if (!t.is_round() || is_zero(t.normal)) return found;
    const auto [tightest, direction] = limits.tightest(t.normal);
    found.along = cross(t.normal, direction);
    found.size = surfmesh::least(t.size, most(tightest, least));
    const double crosswise = most(limits.along(found.along), least);
    found.longer =
        within(surfmesh::least(t.size, crosswise), found.size, t.anisotropy * found.size);
    return found;
}

}  // namespace

TwoSizes TwoSizes::limited(const SizeLimits::Here& limits, double least) const {
    return within_limits(*this, limits, least);
}

void TwoSizes::lower_to(const SizeLimits::Here& limits, double least) {
    if (limits.least() < longer) *this = limited(limits, least);
}

/// Where the metric is not round its size or its longer one is lowered until it keeps to the rim:
/// whichever by less, as a rim that runs slantwise says little of the long direction.
void TwoSizes::lower_to_rim(const RimSize& rim, double least) {
    if (!(rim.size < longer)) return;
    if (is_round()) {
        *this = within_limits(*this, RimLimits{rim}, least);
        return;
    }
    const double onward = square(lane_dot(rim.tangent, along));
    const double wanted = 1.0 / square(most(rim.size, least));
    const double short_part = (1.0 - onward) / square(size), long_part = onward / square(longer);
    double narrower = finite_or_zero(std::sqrt(most(short_part / (wanted - long_part), 0.0)));
    double shorter = finite_or_zero(std::sqrt(most(long_part / (wanted - short_part), 0.0)));
    if (wanted <= long_part) narrower = 0.0;
    if (wanted <= short_part) shorter = 0.0;
    if (!(short_part + long_part < wanted)) return;
    if (narrower >= shorter)
        size *= narrower;
    else
        longer = most(longer * shorter, size);
}

}  // namespace surfmesh
