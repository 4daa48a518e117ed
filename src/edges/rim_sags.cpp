#include "edges/rim_sags.hpp"

#include <algorithm>
#include <array>

#include "values/segment.hpp"

namespace surfmesh {
namespace {

constexpr std::array<double, 3> BETWEEN = {0.25, 0.5, 0.75};
constexpr std::size_t STEP = BETWEEN.size() + 1;  // places from one node to the next

}  // namespace

void rim_sags(const CurvePieces& curves, std::int64_t edge, std::span<const double> fraction,
              RimSags& found) {
    const double t0 = curves.t0[edge], range = curves.t1[edge] - t0;
    const std::size_t segments = fraction.size() - 1;
    Array<double> t;
    for (std::size_t i = 0; i < segments; ++i) {
        const double from = t0 + fraction[i] * range, to = t0 + fraction[i + 1] * range;
        t.push_back(from);
        for (const double fraction : BETWEEN) t.push_back(from + fraction * (to - from));
    }
    t.push_back(t0 + fraction[segments] * range);
    Array<Point3> points(t.size());
    curves.curves[static_cast<std::size_t>(edge)]->evaluate(t, 0, points);

    found.sag.clear();
    found.length.clear();
    for (std::size_t i = 0; i < segments; ++i) {
        const Point3* own = points.data() + STEP * i;
        double sag = 0.0;
        for (std::size_t k = 1; k < STEP; ++k)
            sag = std::max(sag, distance_to_segment(own[k], own[0], own[STEP]));
        found.sag.push_back(sag);
        found.length.push_back(norm(own[STEP] - own[0]));
    }
}

}  // namespace surfmesh
