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

void rim_sags(const Curve& curve, std::span<const double> t, RimSags& found) {
    const std::size_t pieces = t.size() - 1;
    Array<double> places;
    for (std::size_t i = 0; i < pieces; ++i) {
        places.push_back(t[i]);
        for (const double share : BETWEEN) places.push_back(t[i] + share * (t[i + 1] - t[i]));
    }
    places.push_back(t[pieces]);
    Array<Point3> points(places.size());
    curve.evaluate({places.data(), places.size()}, 0, {points.data(), points.size()});

    found.sag.clear();
    found.length.clear();
    for (std::size_t i = 0; i < pieces; ++i) {
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
