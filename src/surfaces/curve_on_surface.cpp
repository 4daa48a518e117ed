#include "surfaces/curve_on_surface.hpp"

#include <algorithm>
#include <limits>

namespace surfmesh {

void CurveOnSurface::evaluate(std::span<const double> t, int order, std::span<Point3> out) const {
    constexpr double NOT_KNOWN = std::numeric_limits<double>::quiet_NaN();
    const int known = std::min(order, 2);
    const std::size_t count = t.size();
    Array<double> p;
    for (const double own : t) p.push_back(shift_ + rate_ * own);
    const CurveValues plane(*pcurve_, {p.data(), count}, known);
    Array<Point2> uv;
    for (const Point3 place : plane[0]) uv.push_back({place.x, place.y});
    SurfaceValues r;
    std::fill(out.begin(), out.end(), Point3{NOT_KNOWN, NOT_KNOWN, NOT_KNOWN});
    if (r.evaluate(*surface_, {uv.data(), count}, known) != SurfaceStatus::DONE) return;
    std::copy(r[0].begin(), r[0].end(), out.begin());
    for (std::size_t i = 0; known > 0 && i < count; ++i) {
        const double du = rate_ * plane[1][i].x, dv = rate_ * plane[1][i].y;
        out[count + i] = du * r[1][i] + dv * r[2][i];
        if (known < 2) continue;
        const double d2u = rate_ * rate_ * plane[2][i].x, d2v = rate_ * rate_ * plane[2][i].y;
        const Point3 bent = du * du * r[3][i] + dv * (du * (2.0 * r[4][i])) + dv * dv * r[5][i];
        out[2 * count + i] = bent + d2u * r[1][i] + d2v * r[2][i];
    }
}

}  // namespace surfmesh
