#include "patch/angle_reduction.hpp"

#include <algorithm>

#include "optimisation/size_reduction.hpp"
#include "patch/findings.hpp"

namespace surfmesh {
namespace {

constexpr int ANGLE_ROUNDS = 6, LAST_ANGLE_ROUNDS = 4, ANGLE_SPLITS = 4;

// Least factor on the sizes in one round, in all, and in the last rounds for a few places.
constexpr double LEAST_ANGLE_FACTOR = 0.85, LEAST_ANGLE_SCALE = 0.6, LAST_ANGLE_SCALE = 0.3;

// Edges of stretched meshes with too large an angle are split from this length: they are not
// many, and smoothing alone mends none.
constexpr double LONGEST_AT_ANGLE = 1.25;

/// The triangles on both sides, each once, in their order.
Array<Triangle> triangles_of(const Dihedrals& found) {
    Array<Triangle> triangles;
    for (const auto [first, second] : found.triangles) {
        triangles.push_back(first);
        triangles.push_back(second);
    }
    std::sort(triangles.begin(), triangles.end());
    const Triangle* end = std::unique(triangles.begin(), triangles.end());
    triangles.resize(static_cast<std::size_t>(end - triangles.begin()));
    return triangles;
}

/// Scale the sizes at the corners of both triangles by what the angle needs.
void lower_sizes_at(PatchState& state, const Dihedrals& found, double limit, double smallest) {
    Array<double> factor(state.t.xy.size(), 1.0);
    for (std::size_t k = 0; k < found.angles.size(); ++k) {
        const double wanted = std::max(limit / found.angles[k], LEAST_ANGLE_FACTOR);
        for (const Triangle triangle : {found.triangles[k].first, found.triangles[k].second})
            for (HalfEdge e = 3 * triangle; e < 3 * triangle + 3; ++e)
                factor[state.t.tri[e]] = std::min(factor[state.t.tri[e]], wanted);
    }
    Array<Vertex> vertices;
    Array<double> factors;
    for (Vertex v = 0; v < state.t.vertices(); ++v) {
        if (!(factor[v] < 1.0)) continue;
        vertices.push_back(v);
        factors.push_back(factor[v]);
    }
    lower_sizes(state.frames, state.marks, vertices, factors, smallest);
}

}  // namespace

void reduce_dihedrals(PatchState& state) {
    if (!state.asked().angle) return;
    const double angle = *state.asked().angle;
    const double longest = state.is_anisotropic() ? LONGEST_AT_ANGLE : LONGEST;
    const int smoothed = ANGLE_ROUNDS + (state.is_anisotropic() ? 0 : LAST_ANGLE_ROUNDS);
    for (int round = 0; round < smoothed + ANGLE_SPLITS && !state.stopped(); ++round) {
        const bool last = round >= ANGLE_ROUNDS;
        const Dihedrals found = find_dihedrals(state, last ? ANGLE_SLACK : ANGLE_MARGIN);
        const double most = angle_limit(angle, ANGLE_SLACK);
        if (!std::any_of(found.angles.begin(), found.angles.end(),
                         [most](double x) { return x > most; }))
            return;
        if (round >= smoothed) {  // as they are smoothed others get too large an angle
            const Array<Triangle> triangles = triangles_of(found);
            state.split_farthest(triangles);
            continue;
        }
        lower_sizes_at(state, found, angle_limit(angle, ANGLE_MARGIN),
                       last ? LAST_ANGLE_SCALE : LEAST_ANGLE_SCALE);
        state.hold_growth(false);
        state.split(longest);
        state.smooth();
        state.smooth();
        state.swap();
    }
}

}  // namespace surfmesh
