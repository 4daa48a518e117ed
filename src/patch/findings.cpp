#include "patch/findings.hpp"

#include <algorithm>
#include <utility>

#include "optimisation/marked_triangles.hpp"
#include "patch/creases.hpp"
#include "patch/deviation.hpp"
#include "patch/folds.hpp"
#include "patch/samples.hpp"
#include "patch/seam_angles.hpp"

namespace surfmesh {
namespace {

// Cosines between the normals of a triangle and of the surface: where it is looked at again, what
// is folded at the centroid, and at a corner.
constexpr double SUSPECT = 0.85, LEAST_AT_CENTRE = 0.55, LEAST_AT_CORNER = 0.35;

// Fraction of ``angle`` from which edges of a seam are made finer when others are bent too far:
// cut anew, it would be other edges that are.
constexpr double NEAR_ANGLE = 0.7;

constexpr std::size_t CORNERS_TOGETHER = 1 << 12;  // triangles whose corners are copied together

SpaceTriangle corners_in_space(const PatchState& state, Triangle k) {
    const auto at = [&](HalfEdge e) { return state.frames.point[state.t.tri[e]]; };
    return {at(3 * k), at(3 * k + 1), at(3 * k + 2)};
}

PlaneTriangle corners_in_plane(const PatchState& state, Triangle k) {
    const auto at = [&](HalfEdge e) { return state.t.xy[state.t.tri[e]]; };
    return {at(3 * k), at(3 * k + 1), at(3 * k + 2)};
}

/// Which vertices the surface has two normals at.
Array<std::uint8_t> marked_kinks(const PatchState& state) {
    Array<std::uint8_t> marked(state.t.xy.size(), 0);
    for (const Vertex v : state.nodes().on_kinks) marked[v] = 1;
    return marked;
}

/// The corners beside an edge: the ends of the half-edge, and the far corner of its triangle.
ParameterTriangle corners_beside(const PatchState& state, HalfEdge e) {
    const auto at = [&](HalfEdge h) { return state.chart().to_uv(state.t.xy[state.t.tri[h]]); };
    return {at(e), at(next_half_edge(e)), at(prev_half_edge(e))};
}

/// Which of the edges the surface has no crease at.
Array<std::uint8_t> without_crease(PatchState& state, const Array<HalfEdgePair>& edges) {
    const Array<Vertex> number = state.identified();
    Array<CornersBesideEdge> beside;
    Array<std::uint8_t> alike;
    for (const auto [e, f] : edges) {
        beside.push_back({corners_beside(state, e), corners_beside(state, f)});
        alike.push_back(number[state.t.tri[e]] == number[state.t.tri[f]]);
    }
    Array<std::uint8_t> kept =
        on_crease(state.surface(), beside, alike, *state.asked().angle, state.diagonal());
    for (std::uint8_t& creased : kept) creased = !creased;
    return kept;
}

}  // namespace

Array<double> deviations(PatchState& state, std::span<const Triangle> triangles, double chord) {
    auto corners = Array<SpaceTriangle>::unfilled(triangles.size());
    auto xy = Array<PlaneTriangle>::unfilled(triangles.size());
    for_each_block(triangles.size(), CORNERS_TOGETHER, [&](std::size_t first, std::size_t last) {
        for (std::size_t k = first; k < last; ++k) {
            corners[k] = corners_in_space(state, triangles[k]);
            xy[k] = corners_in_plane(state, triangles[k]);
        }
    });
    const std::span<const SpaceTriangle> in_space{corners.data(), corners.size()};
    const std::span<const PlaneTriangle> in_plane{xy.data(), xy.size()};
    Array<double> found =
        triangle_deviations(state.surface(), state.chart(), in_space, in_plane, chord);
    if (!state.asked().is_width) return found;
    return triangle_widths(state.surface(), state.chart(), in_space, in_plane, std::move(found));
}

Array<Triangle> find_folds(PatchState& state) {
    const Array<std::uint8_t> suspect = find_folded(state.t, state.frames, SUSPECT, SUSPECT);
    Array<Triangle> suspects, folded;
    Array<SpaceTriangle> corners;
    Array<Point2> uv;
    for (Triangle k = 0; k < state.t.triangles(); ++k) {
        if (!suspect[k]) continue;
        suspects.push_back(k);
        corners.push_back(corners_in_space(state, k));
        uv.push_back(state.chart().to_uv(at_weights(corners_in_plane(state, k), CENTROID)));
    }
    if (suspects.empty()) return folded;
    const Array<std::uint8_t> at_corner = find_folded(state.t, state.frames, LEAST_AT_CORNER, 0.0);
    const Array<double> cosine = cosines_with_surface(state.surface(), corners, uv);
    const Array<std::uint8_t> kink = marked_kinks(state);
    for (std::size_t i = 0; i < suspects.size(); ++i) {
        const HalfEdge e = 3 * suspects[i];
        const Array<Vertex>& tri = state.t.tri;
        // on a kink a corner has the normal of one side, or of neither
        const bool says_nothing = kink[tri[e]] || kink[tri[e + 1]] || kink[tri[e + 2]];
        if (cosine[i] < LEAST_AT_CENTRE || (at_corner[suspects[i]] && !says_nothing))
            folded.push_back(suspects[i]);
    }
    return folded;
}

Dihedrals find_dihedrals(PatchState& state, double margin, bool seams) {
    Dihedrals found;
    if (!state.asked().angle) return found;
    const double limit = angle_limit(*state.asked().angle, margin);
    DihedralAngles over = find_dihedrals_over(state.t, state.frames.point, limit);
    const std::size_t within = over.edges.size();
    if (seams) {
        const DihedralAngles across =
            dihedrals_across_seams(state.t, state.frames.point, state.identified());
        for (std::size_t k = 0; k < across.edges.size(); ++k) {
            if (!(across.angles[k] > NEAR_ANGLE * limit)) continue;
            over.edges.push_back(across.edges[k]);
            over.angles.push_back(across.angles[k]);
        }
    }
    if (over.edges.empty()) return found;
    const Array<std::uint8_t> kept = without_crease(state, over.edges);
    std::size_t end = within;  // seams that are fine as they are, are not counted
    for (std::size_t k = within; k < over.edges.size(); ++k)
        if (kept[k] && over.angles[k] > limit) end = over.edges.size();
    for (std::size_t k = 0; k < end; ++k) {
        if (!kept[k]) continue;
        found.triangles.push_back({over.edges[k].first / 3, over.edges[k].second / 3});
        found.angles.push_back(over.angles[k]);
    }
    return found;
}

}  // namespace surfmesh
