// A triangulated domain with its surface frames, and the passes of the optimiser on it.
//
// In: the triangulation of a domain, which changes in place; its surface, chart and size field,
// which do not; where the nodes of its boundary are, which stay. A pass changes only what is
// active, and marks what it has changed as active and dirty. After each of them the vertices that
// have moved by more than ``kept_drift`` are put back on the true surface.
#pragma once

#include <functional>
#include <optional>

#include "fields/background.hpp"
#include "optimisation/closer_stars.hpp"
#include "optimisation/stars.hpp"
#include "optimisation/surface_frames.hpp"
#include "optimisation/swaps.hpp"
#include "optimisation/vertex_marks.hpp"
#include "patch/limits.hpp"
#include "surfaces/chart.hpp"
#include "surfaces/surface_reader.hpp"

namespace surfmesh {

/// Metric lengths beyond which an edge is collapsed or split.
inline constexpr double SHORTEST = 0.66, LONGEST = 1.45;

/// Weight of unit edges against good shapes: 1 gives better shapes, 4 better lengths.
inline constexpr double STIFFNESS = 2.0;
/// The same in passes for all shapes, and after them.
inline constexpr double SHAPE_STIFFNESS = 0.6;

/// Triangles above this alpha keep their edges.
inline constexpr double GOOD_SHAPE = 0.82;

/// The nodes of a boundary, in a domain that was cut out.
struct BoundaryNodes {
    Array<Vertex> vertex;    // of each node that has one
    Array<Vertex> same;      // of the node that it coincides with in space, or its own
    Array<Vertex> on_kinks;  // vertices where the surface has two normals
    Array<Point3> point;     // of each node where it lies in space; none: on the surface
};

/// What a patch lies on, and what is asked of it. All of it outlives the patch.
struct PatchSetting {
    const Surface& surface;
    const Chart& chart;
    const Background& background;
    AskedAccuracy asked;
    std::function<bool()> before_pass;  // of smoothing: goes on if it says so; may be empty
    bool on_lattice = false;            // triangles are laid along principal directions
    bool has_grown = false;             // circles are larger than the field has them
};

enum class [[nodiscard]] PatchStatus {
    DONE,
    CANCELLED,       // before_pass said so
    SURFACE_FAILED,  // the surface keeps the reason
};

class PatchState {
  public:
    PatchState(Triangulation& t, BoundaryNodes nodes, const PatchSetting& setting);

    Triangulation& t;
    SurfaceFrames frames;
    Stars stars;
    VertexMarks marks;
    Array<double> shape;      // alpha of the triangles, as swaps have last seen it
    Array<Vertex> moved;      // by the last pass of smoothing
    double kept_drift = 0.0;  // what a vertex may move, in unit lengths, before it is put back
    double still;             // what it has to move by for its neighbours to go on, unit lengths
    int swaps = 0, collapses = 0, splits = 0, passes = 0;
    std::int64_t edge_changes = 0;  // how many of them there were, also where ``splits`` go back

    [[nodiscard]] const AskedAccuracy& asked() const { return setting_.asked; }
    [[nodiscard]] const Chart& chart() const { return setting_.chart; }
    [[nodiscard]] const Background& background() const { return setting_.background; }
    [[nodiscard]] const BoundaryNodes& nodes() const { return nodes_; }
    SurfaceReader& surface() { return surface_; }
    [[nodiscard]] bool on_lattice() const { return setting_.on_lattice; }
    [[nodiscard]] bool is_anisotropic() const { return frames.is_anisotropic; }

    /// Whether to give up: no pass does anything any more.
    [[nodiscard]] bool stopped() const { return cancelled_ || surface_.failed(); }
    [[nodiscard]] PatchStatus status() const;

    /// Of the box of all vertices, model units.
    [[nodiscard]] double diagonal() const;
    /// For each vertex the one that it coincides with in space, or itself.
    [[nodiscard]] Array<Vertex> identified() const;

    /// Put vertices back on the surface, with their exact metric.
    void set_frames(std::span<const Vertex> vertices);
    /// Put all vertices that have moved back on the surface.
    void settle();
    /// Give vertices on kinks the mean of the frames around them.
    ///
    /// With the normal of one side, triangles of the other would seem to be turned over.
    void set_frames_on_kinks();
    /// Bring the stars up to date.
    void find_stars();

    /// Move every active vertex by one Newton step; returns how many have moved.
    int smooth(double stiffness = STIFFNESS);
    /// Raise the smallest alpha around triangles below ``least`` by moves of their free corners.
    void raise_worst(double least);
    /// Move the free corners of the triangles until their stars keep the bounds, or are nearer.
    void bring_nearer(std::span<const Triangle> triangles, StarBounds bounds);
    /// Swap edges of the triangles where that brings the pair nearer to the bounds.
    int swap_nearer(std::span<const Triangle> triangles, StarBounds bounds);
    /// Move active vertices to where all triangles lie about as far from the surface, ``allowed`` or
    /// nearer.
    void even_deviations(double allowed);
    /// Swap edges of triangles below the alpha ``good`` while that raises the smaller one.
    void swap(double good = GOOD_SHAPE);
    /// Swap edges that bring the degrees of their four vertices nearer to six.
    void swap_for_degree();
    /// The same at triangles below the alpha ``bad`` on straight borders; returns the swaps made.
    int swap_at_border(double bad);
    /// Remove vertices beside straight borders, of triangles below the alpha ``bad``, without which
    /// degrees are nearer to regular; returns how many went.
    int remove_at_border(double bad);
    /// Remove interior vertices with a short edge, or with few triangles.
    void collapse();
    /// Remove corners of triangles below ``least`` where that raises the smallest alpha around.
    void remove_worst(double least);
    /// Add vertices at triangles below ``least`` where that raises the smallest alpha around.
    void insert_at_worst(double least);
    /// Split interior edges of active vertices longer than ``longest``.
    void split(double longest = LONGEST);
    /// Split the edge of each of the triangles that lies farthest from the surface.
    ///
    /// All other vertices stay where they are. Returns how many were split.
    int split_farthest(std::span<const Triangle> triangles);
    /// Let the patch grow by its part once more, whatever splits have used of it so far.
    void allow_splits();
    /// Lower sizes further around vertices whose sizes are lowered, or around all, until they grow
    /// along no edge by more than is asked. Returns how many were lowered.
    int hold_growth(bool around_all);
    /// Give the nodes of the boundary back the sizes that its segments were cut by, as far as sizes
    /// grow to them from inside. A smaller one there only steers the passes: segments stay as long
    /// as they are, and patches beyond know nothing of it. Lowered sizes stay where they depend on
    /// the direction, as edges are split by them, and where vertices may leave the surface, as
    /// the rounds that move them go on from there.
    void restore_nodes();
    /// Free what only passes need; the frames keep their scales.
    void end_passes();

  private:
    void note(const SwapsMade& made);
    void note_removed(int vertices);
    void renew_frames(std::span<const Vertex> vertices, double drift);
    void set_sized_frames(std::span<const Vertex> vertices, bool on_kink = false);
    void set_block(SurfaceReader& reader, std::span<const Vertex> vertices, bool on_kink);
    void place_nodes();
    void keep_packed_sizes();
    int set_new(Vertex first);

    BoundaryNodes nodes_;
    PatchSetting setting_;
    SurfaceReader surface_;
    bool stars_known_ = false, cancelled_ = false;
    double largest_;  // eigenvalue of a size tensor, near degenerate points
};

}  // namespace surfmesh
