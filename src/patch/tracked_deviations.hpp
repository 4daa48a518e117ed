// How far triangles are from the surface, while vertices move and edges change.
//
// In: a patch, and the distance that is allowed. Out: which triangles have to be measured, and what
// samples on the true surface say. The estimate from the tangent planes is off by a factor that
// hardly changes where a triangle moves a little: it is kept with each triangle that was measured.
// So after small moves only those are measured whose estimate times the factor comes near to what
// is allowed; never measured ones as soon as the bare estimate does. What a triangle was is
// forgotten when it gets other corners.
#pragma once

#include "patch/patch_state.hpp"

namespace surfmesh {

/// Those of the triangles with more than ``limit``.
Array<Triangle> farther_than(double limit, const Array<Triangle>& triangles,
                             const Array<double>& deviation);

class TrackedDeviations {
  public:
    TrackedDeviations(PatchState& state, double chord);

    /// All triangles that have to be measured.
    [[nodiscard]] Array<Triangle> suspects() const;
    /// All that are far because sizes are not to be below ``min_size``.
    Array<Triangle> held();
    /// From here on triangles near this part of what is allowed have all samples.
    void look_near(double part) { looked_at_ = part * chord_; }
    /// Distances of the triangles by samples; 0 where only sizes below ``min_size`` would mend them.
    Array<double> measure(const Array<Triangle>& triangles);
    /// Those of the triangles that are farther than ``limit``, by samples.
    Array<Triangle> farther(const Array<Triangle>& triangles, double limit);
    /// The farthest of them: those in the upper half of what they exceed the limit by.
    Array<Triangle> farthest(const Array<Triangle>& triangles, double limit);

    /// Changes count from here on.
    void start_round();
    /// The vertices that the last pass of the patch has moved.
    void add_moved();
    /// Of the triangles with a vertex that has moved, or with one of a triangle that has changed,
    /// those that have to be measured; and ``others``.
    Array<Triangle> changed(const Array<Triangle>& others);

  private:
    [[nodiscard]] bool is_suspect(Triangle k) const;
    /// Is it far, by the estimate, because its size is not to be below ``min_size``?
    [[nodiscard]] bool is_held(Triangle k) const;
    Array<double> measure_all(const Array<Triangle>& triangles);
    Array<double> measure_free(const Array<Triangle>& triangles);
    [[nodiscard]] Array<HalfEdge> new_corners() const;
    void note_corners();

    PatchState& state_;
    double chord_;
    double looked_at_;                        // near it triangles have all samples
    double suspect_, suspect_once_measured_;  // estimates from which triangles are measured
    Array<float> factor_;                     // measured over estimated; 0: not measured
    Array<Vertex> before_;                    // corners at the start of the round
    std::int64_t edges_before_ = -1;          // ``edge_changes`` when they were
    Array<std::uint8_t> is_changed_;          // vertices
};

}  // namespace surfmesh
