#include "edges/rim_sags.hpp"

#include <algorithm>
#include <array>
#include <limits>

namespace surfmesh {
namespace {

constexpr std::array<double, 3> BETWEEN = {0.25, 0.5, 0.75};
constexpr std::size_t STEP = BETWEEN.size() + 1;  // places from one node to the next

double distance_to_chord(Point3 point, Point3 start, Point3 chord, double squared) {
    const Point3 way = point - start;
    const double along = std::clamp(dot(way, chord) / squared, 0.0, 1.0);
    return norm(way - along * chord);
}

}  // namespace

void rim_sags(const CurvePieces& curves, std::int64_t edge, std::span<const double> fraction,
              RimSags& found) {
    const double t0 = curves.t0[edge], range = curves.t1[edge] - t0;
    const std::size_t segments = fraction.size() - 1;
    Array<double> t;
    for (std::size_t i = 0; i < segments; ++i) {
        const double from = t0 + fraction[i] * range, to = t0 + fraction[i + 1] * range;
        t.push_back(from);
        for (const double share : BETWEEN) t.push_back(from + share * (to - from));
    }
    t.push_back(t0 + fraction[segments] * range);
    Array<Point3> points(t.size());
    curves.curves[static_cast<std::size_t>(edge)]->evaluate({t.data(), t.size()}, 0,
                                                            {points.data(), points.size()});

    found.sag.clear();
    found.length.clear();
    for (std::size_t i = 0; i < segments; ++i) {
        const Point3* own = points.data() + STEP * i;
        const Point3 chord = own[STEP] - own[0];
        const double squared = std::max(dot(chord, chord), std::numeric_limits<double>::min());
        double sag = 0.0;
        for (std::size_t k = 1; k < STEP; ++k)
            sag = std::max(sag, distance_to_chord(own[k], own[0], chord, squared));
        found.sag.push_back(sag);
        found.length.push_back(norm(chord));
    }
}

}  // namespace surfmesh
