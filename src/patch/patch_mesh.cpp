#include "patch/patch_mesh.hpp"

#include <algorithm>
#include <utility>

#include "packing/packing_in_halves.hpp"
#include "patch/even_use.hpp"
#include "patch/lattice_edge.hpp"
#include "patch/node_bends.hpp"
#include "patch/schedule.hpp"

namespace surfmesh {
namespace {

/// A way through the stages, which ends where one of them cannot be done.
class PatchWork {
  public:
    PatchWork(const PatchTask& task, std::span<const Point2> uv, const PatchBoundary& boundary,
              const PatchHooks& hooks)
        : task_(task), uv_(uv), boundary_(boundary), hooks_(hooks) {}

    PatchMesh mesh() && {
        if (packed() && recovered()) optimise_and_map();
        return std::move(made_);
    }

  private:
    [[nodiscard]] bool begins(PatchStage stage) {
        const bool goes_on = !hooks_.before_stage || hooks_.before_stage(stage);
        if (!goes_on) made_.end = PatchEnd::cancelled;
        return goes_on;
    }
    [[nodiscard]] bool follows_directions() const;
    [[nodiscard]] Array<NodeBend> bends_of_field();
    [[nodiscard]] bool packed();
    [[nodiscard]] bool recovered();
    void optimise_and_map();
    [[nodiscard]] BoundaryNodes nodes_in_use() const;
    [[nodiscard]] Array<Point2> parameters_in_use() const;
    [[nodiscard]] Array<std::uint8_t> off_surface(PatchState& state) const;
    [[nodiscard]] IdentifiedBoundary identified() const;
    void add_roots(const PatchState& state);
    [[nodiscard]] bool has_stopped(const PatchState& state);

    const PatchTask& task_;
    const std::span<const Point2> uv_;
    const PatchBoundary& boundary_;
    const PatchHooks& hooks_;
    Triangulation plane_;
    bool has_grown_ = false;
    PatchMesh made_;
};

/// Do sizes grow where the direction of edges allows it?
bool PatchWork::follows_directions() const {
    return task_.optimise && uses_evenly(task_.asked, task_.background);
}

/// None where sizes do not.
Array<NodeBend> PatchWork::bends_of_field() {
    if (!follows_directions()) return {};
    SurfaceReader surface(task_.surface);
    Array<NodeBend> found =
        node_bends(surface, task_.chart, task_.background, task_.asked, task_.on_lattice);
    if (surface.failed()) made_.end = PatchEnd::surface_failed;
    const bool any = std::any_of(found.begin(), found.end(),
                                 [](const NodeBend& bend) { return bend.decided > 0.0; });
    return any ? found : Array<NodeBend>{};
}

bool PatchWork::packed() {
    if (!begins(PatchStage::packing)) return false;
    std::optional<Point2> edge;
    if (task_.on_lattice || follows_directions())
        edge = lattice_edge(task_.surface, task_.chart, 0.5 * (task_.low + task_.high),
                            task_.background.is_anisotropic());
    const Array<NodeBend> bend = bends_of_field();
    has_grown_ = !bend.empty();
    if (made_.end != PatchEnd::done) return false;
    const AskedAccuracy& asked = task_.asked;
    const CircleSizes sizes{
        task_.background, {bend.data(), bend.size()}, USED_EVENLY, asked.largest, asked.is_width};
    Packing packing =
        pack_box(sizes, task_.low, task_.high, task_.expected, hooks_.while_packing, edge);
    made_.packing = packing.end;
    made_.circles = packing.t.vertices();
    std::swap(plane_, packing.t);
    if (packing.end.status == PackingStatus::finished) return true;
    made_.end = packing.end.status == PackingStatus::stopped ? PatchEnd::cancelled
                                                             : PatchEnd::packing_failed;
    return false;
}

bool PatchWork::recovered() {
    if (!begins(PatchStage::boundary)) return false;
    RecoveredDomain found;
    if (const auto* loops = std::get_if<LoopBoundary>(&boundary_))
        found = recover(std::move(plane_), task_.background, *loops);
    else
        found = recover_regions(std::move(plane_), task_.background,
                                std::get<PlanarBoundary>(boundary_));
    made_.boundary = found.outcome;
    made_.domain = std::move(found.domain);
    if (found.outcome.status == Recovery::finished) return true;
    made_.end = PatchEnd::boundary_failed;
    return false;
}

void PatchWork::optimise_and_map() {
    if (task_.optimise && !begins(PatchStage::optimisation)) return;
    PatchState state(made_.domain.t, nodes_in_use(),
                     {task_.surface, task_.chart, task_.background, task_.asked, hooks_.before_pass,
                      task_.on_lattice, has_grown_});
    if (task_.optimise) {
        const Unmended left = optimise(state, task_.first);
        const Array<std::uint8_t> off = off_surface(state);
        if (!state.stopped()) made_.requests = size_requests(state, left, off, task_.first);
        state.restore_nodes();
        state.hold_growth(true);  // what has moved and was swapped last has other neighbours
    } else {
        choose_diagonals(state);
    }
    if (has_stopped(state) || !begins(PatchStage::mapping)) return;
    const Array<Point2> uv = parameters_in_use();
    made_.mapped = map_to_space(state, uv, identified());
    add_roots(state);
    static_cast<void>(has_stopped(state));
}

/// The nodes of the boundary that have a vertex.
BoundaryNodes PatchWork::nodes_in_use() const {
    const DomainMesh& domain = made_.domain;
    BoundaryNodes nodes{{}, {}, domain.on_kinks, {}};
    for (std::size_t k = 0; k < domain.node.size(); ++k) {
        if (domain.node[k] == NIL) continue;
        nodes.vertex.push_back(domain.node[k]);
        nodes.same.push_back(domain.same[k]);
        if (!domain.points.empty()) nodes.point.push_back(domain.points[k]);
    }
    return nodes;
}

Array<Point2> PatchWork::parameters_in_use() const {
    Array<Point2> uv;
    for (std::size_t k = 0; k < uv_.size(); ++k)
        if (made_.domain.node[k] != NIL) uv.push_back(uv_[k]);
    return uv;
}

/// Marks of the nodes in use that lie so far off the surface that smaller sizes are no help.
Array<std::uint8_t> PatchWork::off_surface(PatchState& state) const {
    Array<std::uint8_t> off;
    const Array<Point3>& point = state.nodes().point;
    if (!task_.asked.chord || point.empty() || state.stopped()) return off;
    const Array<Point2> uv = parameters_in_use();
    state.surface().read(uv, 0);
    const std::span<const Point3> image = state.surface()[0];
    for (std::size_t k = 0; k < point.size(); ++k)
        off.push_back(norm(point[k] - image[k]) > OFF_SURFACE * *task_.asked.chord);
    return off;
}

IdentifiedBoundary PatchWork::identified() const {
    const auto* loops = std::get_if<LoopBoundary>(&boundary_);
    if (loops == nullptr) return {};
    const Array<Vertex>& node = made_.domain.node;
    return {node, loops->segments, loops->identity};
}

void PatchWork::add_roots(const PatchState& state) {
    if (!task_.with_roots) return;
    for (Vertex v = 0; v < state.t.vertices(); ++v) {
        const Point2 p = state.t.xy[v];
        const MetricRoot3 w = task_.background.metric_root_3d_at(p.x, p.y);
        const double scale = state.frames.scale[v];
        made_.metric_root.push_back(
            {w.xx / scale, w.xy / scale, w.xz / scale, w.yy / scale, w.yz / scale, w.zz / scale});
    }
}

bool PatchWork::has_stopped(const PatchState& state) {
    if (state.status() == PatchStatus::SURFACE_FAILED) made_.end = PatchEnd::surface_failed;
    if (state.status() == PatchStatus::CANCELLED) made_.end = PatchEnd::cancelled;
    return state.stopped();
}

}  // namespace

PatchMesh mesh_patch(const PatchTask& task, std::span<const Point2> uv,
                     const PatchBoundary& boundary, const PatchHooks& hooks) {
    return PatchWork(task, uv, boundary, hooks).mesh();
}

}  // namespace surfmesh
