#include "patch/creases.hpp"

#include <cmath>
#include <utility>

#include "patch/limits.hpp"
#include "sizing/curvature_sizes.hpp"
#include "surfaces/fundamental_forms.hpp"

namespace surfmesh {
namespace {

// Normals are read so far inside the triangles, as a fraction of the way to the centroid: at an
// apex there is none, and at a crease one for each side.
constexpr double INSIDE = 1e-3;

// Cosine of one degree, between the normals on both sides: from there it is a crease.
constexpr double CREASE = 0.9998476951563913;

bool same_place(Point2 a, Point2 b) { return a.x == b.x && a.y == b.y; }

/// The corners of a triangle, moved a little inside.
ParameterTriangle moved_inside(const ParameterTriangle& t) {
    const Point2 sum = t[0] + t[1] + t[2], centre = {sum.x / 3.0, sum.y / 3.0};
    ParameterTriangle inside;
    for (std::size_t i = 0; i < 3; ++i) inside[i] = t[i] + INSIDE * (centre - t[i]);
    return inside;
}

/// The unit normal at a sample, and whether the surface is as good as bent there.
struct NormalAt {
    Point3 normal;
    bool sharp;
};

NormalAt normal_at(const SurfaceReader& surface, std::size_t i, double angle, double least) {
    const FundamentalForms forms = fundamental_forms(surface[1][i], surface[2][i],
                                                     {surface[3][i], surface[4][i], surface[5][i]});
    const Point3 n = forms.normal;
    const PrincipalCurvatures k = principal_curvatures(forms);
    const bool known =
        !forms.degenerate && std::isfinite(n.x) && std::isfinite(n.y) && std::isfinite(n.z);
    return {n, !known || angle_size(k, angle) < least};
}

}  // namespace

Array<std::uint8_t> on_crease(SurfaceReader& surface, std::span<const CornersBesideEdge> edges,
                              std::span<const std::uint8_t> alike, double angle, double diagonal) {
    Array<CornersBesideEdge> turned;
    Array<Point2> uv;
    for (std::size_t k = 0; k < edges.size(); ++k) {
        turned.push_back(edges[k]);
        if (alike[k]) std::swap(turned.back().second[0], turned.back().second[1]);
        for (const Point2 p : moved_inside(turned.back().first)) uv.push_back(p);
        for (const Point2 p : moved_inside(turned.back().second)) uv.push_back(p);
    }
    surface.read(uv, 2);
    Array<std::uint8_t> bent(edges.size(), 0);
    for (std::size_t k = 0; k < edges.size(); ++k) {
        std::array<NormalAt, 6> at;
        for (std::size_t i = 0; i < 6; ++i) {
            at[i] = normal_at(surface, 6 * k + i, angle, FINEST_BY_ANGLE * diagonal);
            if (at[i].sharp) bent[k] = 1;
        }
        double start = lane_dot(at[0].normal, at[4].normal);
        double end = lane_dot(at[1].normal, at[3].normal);
        const auto& [first, second] = turned[k];
        // the sign depends on the parametrisation, which may turn over at a seam, not within
        if (!same_place(first[0], second[1]) || !same_place(first[1], second[0])) {
            start = std::abs(start);
            end = std::abs(end);
        }
        if (std::min(start, end) < CREASE) bent[k] = 1;
    }
    return bent;
}

}  // namespace surfmesh
