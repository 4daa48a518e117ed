#include "patch/size_requests.hpp"

#include <cmath>

#include "patch/deviation.hpp"
#include "surfaces/sharp_bends.hpp"

namespace surfmesh {
namespace {

constexpr double FOLD_FACTOR = 0.6;  // on the sizes where triangles are folded

// Least and largest factor on the sizes where triangles are too far, or their angles too large.
constexpr double CHORD_FACTORS[] = {0.5, 0.8}, ANGLE_FACTORS[] = {0.5, 0.85};

constexpr double LOWER = 0.97;  // what asks for more than this fraction of the size is no request

double clipped(double x, const double (&range)[2]) {
    return std::min(std::max(x, range[0]), range[1]);
}

/// What is asked for where ``min_size`` binds.
struct BoundedRequests {
    double lower;  // what leaves more than this fraction of the size is no request
    double next;   // what is asked for is cut if this part of it is below ``min_size``
};
constexpr BoundedRequests NONE_CUT{LOWER, 1.0}, CUT_AT_FIRST{WORTH_A_ROUND, 1.0},
    CUT_LATER{0.7, 0.95};

/// The smallest factor that is wanted at each vertex; 1 where none is.
class WantedFactors {
  public:
    explicit WantedFactors(const PatchState& state)
        : state_(state), factor_(state.t.xy.size(), 1.0) {}

    void want(Triangle k, double factor) {
        for (HalfEdge e = 3 * k; e < 3 * k + 3; ++e) {
            double& smallest = factor_[state_.t.tri[e]];
            smallest = std::min(smallest, factor);
        }
    }
    /// The field's sizes times the factors, where that is smaller than now: not below ``least``,
    /// which no mesh needs, nor below the smallest size asked for.
    [[nodiscard]] SizeLimitArrays limits(double least, BoundedRequests cut) const;

  private:
    const PatchState& state_;
    Array<double> factor_;
};

SizeLimitArrays WantedFactors::limits(double least, BoundedRequests cut) const {
    const SurfaceFrames& s = state_.frames;
    const double min_size = state_.asked().min_size;
    SizeLimitArrays found;
    for (Vertex v = 0; v < state_.t.vertices(); ++v) {
        if (!(factor_[v] < 1.0)) continue;
        const double now = s.size[v] / s.scale[v];
        const double wanted = std::max(factor_[v] * now, least), size = std::max(wanted, min_size);
        if (!(size < (cut.next * wanted < min_size ? cut.lower : LOWER) * now)) continue;
        found.points.push_back(s.point[v]);
        found.sizes.push_back(size);
        if (!s.is_anisotropic) continue;
        const double shrunk = s.scale[v] * now / size;
        const MetricRoot3& w = s.metric_root[v];
        found.uv.push_back(state_.chart().to_uv(state_.t.xy[v]));
        found.metric_root.push_back({w.xx * shrunk, w.xy * shrunk, w.xz * shrunk, w.yy * shrunk,
                                     w.yz * shrunk, w.zz * shrunk});
    }
    return found;
}

/// Limits under which triangles would come to lie within ``chord``.
SizeLimitArrays limits_for_chord(PatchState& state, const Array<Triangle>& triangles,
                                 BoundedRequests cut) {
    const double chord = *state.asked().chord;
    const Array<double> error = deviations(state, triangles, chord);
    WantedFactors wanted(state);
    for (std::size_t k = 0; k < triangles.size(); ++k)
        wanted.want(triangles[k],
                    clipped(std::sqrt(CHORD_MARGIN * chord / error[k]), CHORD_FACTORS));
    return wanted.limits(2.0 * chord, cut);
}

/// Limits under which folded triangles may unfold.
///
/// None where the surface itself turns over, or bends sharply: no size is small enough.
SizeLimitArrays limits_for_folds(PatchState& state, const Array<Triangle>& triangles) {
    Array<ParameterTriangle> uv;
    const auto at = [&](HalfEdge e) { return state.chart().to_uv(state.t.xy[state.t.tri[e]]); };
    for (const Triangle k : triangles) uv.push_back({at(3 * k), at(3 * k + 1), at(3 * k + 2)});
    const double radius = sharp_radius(state.asked(), state.diagonal());
    const Array<std::uint8_t> sharp = bends_sharply(state.surface(), uv, radius);
    WantedFactors wanted(state);
    for (std::size_t k = 0; k < triangles.size(); ++k)
        if (!sharp[k]) wanted.want(triangles[k], FOLD_FACTOR);
    return wanted.limits(LEAST_OF_CHORD * state.asked().chord.value_or(0.0), NONE_CUT);
}

/// Limits under which triangles would meet at no more than ``angle``.
SizeLimitArrays limits_for_angle(PatchState& state, const Dihedrals& dihedrals,
                                 BoundedRequests cut) {
    const double limit = angle_limit(*state.asked().angle, ANGLE_MARGIN);
    WantedFactors wanted(state);
    for (std::size_t k = 0; k < dihedrals.angles.size(); ++k) {
        const double factor = clipped(limit / dihedrals.angles[k], ANGLE_FACTORS);
        wanted.want(dihedrals.triangles[k].first, factor);
        wanted.want(dihedrals.triangles[k].second, factor);
    }
    return wanted.limits(FINEST_BY_ANGLE * state.diagonal(), cut);
}

/// The triangles with no node at a corner that is marked.
Array<Triangle> without(const PatchState& state, const Array<Triangle>& triangles,
                        std::span<const std::uint8_t> marked_nodes) {
    const Array<Vertex>& tri = state.t.tri;
    Array<std::uint8_t> marked(state.t.xy.size(), 0);
    for (std::size_t k = 0; k < marked_nodes.size(); ++k)
        if (marked_nodes[k]) marked[state.nodes().vertex[k]] = 1;
    Array<Triangle> kept;
    for (const Triangle k : triangles)
        if (!(marked[tri[3 * k]] || marked[tri[3 * k + 1]] || marked[tri[3 * k + 2]]))
            kept.push_back(k);
    return kept;
}

}  // namespace

SizeRequests size_requests(PatchState& state, const Unmended& left,
                           std::span<const std::uint8_t> off_surface, bool first) {
    const BoundedRequests cut = first ? CUT_AT_FIRST : CUT_LATER;
    SizeRequests requests;
    const Array<Triangle> far = without(state, left.far, off_surface);
    const Array<Triangle> folded = without(state, left.folded, off_surface);
    if (!far.empty()) requests.chord = limits_for_chord(state, far, cut);
    if (!folded.empty()) requests.folds = limits_for_folds(state, folded);
    if (!left.dihedrals.angles.empty())
        requests.angle = limits_for_angle(state, left.dihedrals, cut);
    return requests;
}

}  // namespace surfmesh
