// One (u, v) domain and one size field become triangles, without a break.
//
// packing -> boundary -> optimisation -> space, joined sides identified
//                            |
//                            +-> size requests, for another round, where this did not do
//
// In: a surface, its chart and size field, the boundary cut to lengths, what is asked for. Out: the
// domain, its triangles in space, the requests; or which stage could not be done, and how it ended.
// Whole surfaces, faces of CAD models, planar domains and trial patches all go this way.
#pragma once

#include <functional>
#include <span>
#include <variant>

#include "insertion/boundary_recovery.hpp"
#include "packing/packing.hpp"
#include "patch/mapping.hpp"
#include "patch/patch_state.hpp"
#include "patch/size_requests.hpp"

namespace surfmesh {

/// Fraction of ``chord`` by which a node may lie off the surface of a face that uses it.
inline constexpr double OFF_SURFACE = 0.3;

enum class PatchStage : std::uint8_t { packing, boundary, optimisation, mapping };

/// Who is told how the work goes on, and may end it by saying no; all may be empty.
struct PatchHooks {
    std::function<bool(PatchStage)> before_stage;
    Watch while_packing;
    std::function<bool()> before_pass;  // of smoothing
};

/// Loops of a surface, or segments of a planar domain; both with nodes in the scaled plane.
using PatchBoundary = std::variant<LoopBoundary, PlanarBoundary>;

/// What is meshed, and how. All of it outlives the call.
struct PatchTask {
    const Surface& surface;
    const Chart& chart;
    const Background& background;
    AskedAccuracy asked;
    Point2 low, high;         // box of the plane that is packed, from its middle
    std::size_t expected;     // circles in it, about
    bool optimise = true;     // else only diagonals are chosen
    bool first = true;        // the sizes come from no earlier round
    bool with_roots = false;  // W of the vertices is wanted
    bool on_lattice = false;  // sizes are for a lattice laid along principal directions
};

enum class [[nodiscard]] PatchEnd : std::uint8_t {
    done,
    packing_failed,   // see ``packing``
    boundary_failed,  // see ``boundary``
    surface_failed,   // the surface keeps the reason
    cancelled,        // a hook has said no
};

struct PatchMesh {
    PatchEnd end = PatchEnd::done;
    PackingEnd packing{PackingStatus::finished, {0.0, 0.0}};
    Vertex circles = 0;
    BoundaryOutcome boundary;
    DomainMesh domain;
    MappedPatch mapped;
    Array<MetricRoot3> metric_root;  // of the domain's vertices: W over their scale, if wanted
    SizeRequests requests;
};

/// uv: of the boundary's nodes, to the last bit.
PatchMesh mesh_patch(const PatchTask& task, std::span<const Point2> uv,
                     const PatchBoundary& boundary, const PatchHooks& hooks);

}  // namespace surfmesh
