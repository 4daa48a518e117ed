#include "patch/patch_state.hpp"

#include <cmath>
#include <limits>
#include <numeric>
#include <utility>

#include "optimisation/collapse.hpp"
#include "optimisation/even_deviations.hpp"
#include "optimisation/scale_gradation.hpp"
#include "optimisation/smoothing.hpp"
#include "optimisation/splits.hpp"
#include "optimisation/star_insertion.hpp"
#include "optimisation/worst_shapes.hpp"
#include "optimisation/worst_stars.hpp"

namespace surfmesh {
namespace {

constexpr int FEW = 4;  // an interior vertex with at most this many triangles is removed
constexpr double LEAST_FOR_DEGREE = 0.4;      // worst alpha that a swap for degrees may leave
constexpr double LONGEST_UNSMOOTHED = 1.7;    // edge where a vertex goes for the sake of degrees
constexpr double CLEARLY_GROWN = 1.0 + 1e-9;  // not by rounding alone
constexpr double MOST_GROWN = 1.5;            // what is larger has moved since it was packed
constexpr int SWEEPS = 8;                     // of swaps over all edges, at most
constexpr std::size_t VERTICES_TOGETHER = 1 << 12;  // vertices put on the surface together

// Of the domain: how far from a kink its two sides are looked at, and in which directions.
constexpr double BESIDE_KINK = 1e-6;
constexpr Point2 AROUND_KINK[] = {{1.0, 0.4}, {-1.0, -0.4}, {0.4, -1.0}, {-0.4, 1.0}};

Array<Vertex> vertices_from(Vertex first, Vertex end) {
    Array<Vertex> numbers(static_cast<std::size_t>(end - first));
    std::iota(numbers.begin(), numbers.end(), first);
    return numbers;
}

/// A patch may grow by so much while it is optimised, and by a few more. What needs more splits than
/// that asks for smaller sizes: they cost fewer triangles, and on a faulty face splits have no end.
std::size_t most_vertices(std::size_t vertices, bool anisotropic) {
    return vertices + vertices / (anisotropic ? 2 : 16) + 64;
}

/// r_u and r_v on kinks: the mean of what they are around.
void read_mean_slopes(SurfaceReader& surface, std::span<const Point2> uv, Array<Point3>& ru,
                      Array<Point3>& rv) {
    const ParameterBox box = surface.domain();
    const Point2 step = BESIDE_KINK * (box.high - box.low);
    ru.resize(uv.size());
    rv.resize(uv.size());
    Array<Point2> places(uv.size());
    for (std::size_t way = 0; way < std::size(AROUND_KINK); ++way) {
        for (std::size_t k = 0; k < uv.size(); ++k) {
            const Point2 to = {uv[k].x + step.x * AROUND_KINK[way].x,
                               uv[k].y + step.y * AROUND_KINK[way].y};
            places[k] = {std::min(std::max(to.x, box.low.x), box.high.x),
                         std::min(std::max(to.y, box.low.y), box.high.y)};
        }
        surface.read(places, 1);
        for (std::size_t k = 0; k < uv.size(); ++k) {
            ru[k] = way == 0 ? surface[1][k] : ru[k] + surface[1][k];
            rv[k] = way == 0 ? surface[2][k] : rv[k] + surface[2][k];
        }
    }
    constexpr double FRACTION = 1.0 / std::size(AROUND_KINK);
    for (std::size_t k = 0; k < uv.size(); ++k) {
        ru[k] = FRACTION * ru[k];
        rv[k] = FRACTION * rv[k];
    }
}

/// Of stars that lose a vertex: edges up to ``longest``, no farther from the surface than asked.
FillingLimits filling_limits(const AskedAccuracy& asked, double longest) {
    return {longest, asked.chord.value_or(std::numeric_limits<double>::infinity())};
}

}  // namespace

PatchState::PatchState(Triangulation& triangulation, BoundaryNodes nodes,
                       const PatchSetting& setting)
    : t(triangulation),
      frames(t.xy.size(), setting.background.is_anisotropic(),
             most_vertices(t.xy.size(), setting.background.is_anisotropic())),
      marks(t.xy.size()),
      still(frames.is_anisotropic ? STILL_STRETCHED : STILL),
      nodes_(std::move(nodes)),
      setting_(setting),
      surface_(setting.surface),
      largest_(1e3 * setting.background.box.largest /
               std::max(setting.chart.u.extent, setting.chart.v.extent)) {
    frames.limits = {setting.asked.min_size, most_vertices(t.xy.size(), frames.is_anisotropic)};
    if (setting_.has_grown) keep_packed_sizes();
    set_frames(vertices_from(0, t.vertices()));
    place_nodes();
}

/// Circles that have grown beyond the sizes of the field are to stay as large.
void PatchState::keep_packed_sizes() {
    for_each_block(t.xy.size(), VERTICES_TOGETHER, [&](std::size_t first, std::size_t last) {
        for (std::size_t v = first; v < last; ++v) {
            const SizeTensor h = background().size_at(t.xy[v].x, t.xy[v].y);
            const double grown = determinant(t.size[v]) / determinant(h);
            if (grown > CLEARLY_GROWN) frames.scale[v] = std::min(std::sqrt(grown), MOST_GROWN);
        }
    });
}

PatchStatus PatchState::status() const {
    if (surface_.failed()) return PatchStatus::SURFACE_FAILED;
    return cancelled_ ? PatchStatus::CANCELLED : PatchStatus::DONE;
}

double PatchState::diagonal() const {
    if (frames.point.empty()) return 0.0;
    Point3 low = frames.point[0], high = low;
    for (const Point3 p : frames.point) {
        low = {std::min(low.x, p.x), std::min(low.y, p.y), std::min(low.z, p.z)};
        high = {std::max(high.x, p.x), std::max(high.y, p.y), std::max(high.z, p.z)};
    }
    return norm(high - low);
}

Array<Vertex> PatchState::identified() const {
    Array<Vertex> number = vertices_from(0, t.vertices());
    for (std::size_t k = 0; k < nodes_.vertex.size(); ++k)
        number[nodes_.vertex[k]] = nodes_.same[k];
    return number;
}

void PatchState::set_frames(std::span<const Vertex> vertices) {
    for_each_block(vertices.size(), VERTICES_TOGETHER, [&](std::size_t first, std::size_t last) {
        for (const Vertex v : vertices.subspan(first, last - first))
            set_size(t, frames, setting_.background, v);
    });
    set_sized_frames(vertices);
}

/// The same where sizes are those of the places already.
void PatchState::set_sized_frames(std::span<const Vertex> vertices, bool on_kink) {
    surface_.for_each_block(vertices.size(), VERTICES_TOGETHER,
                            [&](SurfaceReader& reader, std::size_t first, std::size_t last) {
                                set_block(reader, vertices.subspan(first, last - first), on_kink);
                            });
}

void PatchState::set_block(SurfaceReader& reader, std::span<const Vertex> vertices, bool on_kink) {
    Array<Point2> uv(vertices.size());
    Array<ChartPoint> at(vertices.size());
    for (std::size_t k = 0; k < vertices.size(); ++k) {
        at[k] = setting_.chart.at(t.xy[vertices[k]]);
        uv[k] = at[k].uv;
    }
    Array<Point3> ru, rv;
    if (on_kink) read_mean_slopes(reader, uv, ru, rv);
    reader.read(uv, 1);
    for (std::size_t k = 0; k < vertices.size(); ++k) {
        const Point3 du = on_kink ? ru[k] : reader[1][k], dv = on_kink ? rv[k] : reader[2][k];
        set_frame(t, frames, vertices[k], {reader[0][k], at[k].by_x(du, dv), at[k].by_y(du, dv)},
                  largest_);
    }
}

void PatchState::renew_frames(std::span<const Vertex> vertices, double drift) {
    const Array<Vertex> far =
        collect_by_blocks<Vertex>(vertices.size(), VERTICES_TOGETHER,
                                  [&](std::size_t first, std::size_t last, Array<Vertex>& own) {
                                      for (const Vertex v : vertices.subspan(first, last - first))
                                          if (frames.drift[v] > drift) own.push_back(v);
                                  });
    set_frames(far);
}

void PatchState::settle() { renew_frames(vertices_from(0, t.vertices()), 0.0); }

void PatchState::set_frames_on_kinks() {
    if (nodes_.on_kinks.empty()) return;
    set_sized_frames(nodes_.on_kinks, true);
    place_nodes();
}

/// Boundary nodes lie where edges have them, or on each other to the last bit.
void PatchState::place_nodes() {
    const std::size_t count = nodes_.vertex.size();
    if (!nodes_.point.empty()) {
        for (std::size_t k = 0; k < count; ++k) frames.point[nodes_.vertex[k]] = nodes_.point[k];
        return;
    }
    Array<Point3> points;
    for (const Vertex v : nodes_.same) points.push_back(frames.point[v]);
    for (std::size_t k = 0; k < count; ++k) frames.point[nodes_.vertex[k]] = points[k];
}

void PatchState::find_stars() {
    if (stars_known_) return;
    surfmesh::find_stars(t, stars);
    for (const Vertex v : nodes_.vertex) stars.frozen[v] = 1;
    stars_known_ = true;
}

int PatchState::smooth(double stiffness) {
    moved.clear();
    if (!stopped() && setting_.before_pass) cancelled_ = !setting_.before_pass();
    if (stopped()) return 0;
    find_stars();
    surfmesh::smooth(t, frames, stars, marks, stiffness, still, moved);
    renew_frames(moved, kept_drift);
    ++passes;
    return static_cast<int>(moved.size());
}

void PatchState::raise_worst(double least) {
    if (stopped()) return;
    find_stars();
    surfmesh::raise_worst(t, frames, stars, marks, least, moved);
    renew_frames(moved, kept_drift);
}

void PatchState::bring_nearer(std::span<const Triangle> triangles, StarBounds bounds) {
    if (stopped()) return;
    find_stars();
    surfmesh::bring_nearer(t, frames, stars, marks, triangles, bounds, moved);
    renew_frames(moved, kept_drift);
}

int PatchState::swap_nearer(std::span<const Triangle> triangles, StarBounds bounds) {
    if (stopped()) return 0;
    find_stars();
    const SwapsMade made = surfmesh::swap_nearer(t, frames, stars, marks, triangles, bounds);
    note(made);
    return made.count;
}

void PatchState::even_deviations(double allowed) {
    moved.clear();
    if (!stopped() && setting_.before_pass) cancelled_ = !setting_.before_pass();
    if (stopped()) return;
    find_stars();
    surfmesh::even_deviations(t, frames, stars, marks, allowed, moved);
    renew_frames(moved, kept_drift);
}

void PatchState::swap(double good) {
    if (stopped()) return;
    note(swap_for_shape(t, frames, shape, stars_known_ ? &stars : nullptr, marks, good, SWEEPS));
}

void PatchState::swap_for_degree() {
    if (stopped()) return;
    find_stars();
    note(surfmesh::swap_for_degree(t, frames, stars, marks, LEAST_FOR_DEGREE));
}

int PatchState::swap_at_border(double bad) {
    if (stopped() || shape.size() < t.region.size()) return 0;
    find_stars();
    const SwapsMade made =
        surfmesh::swap_at_border(t, frames, stars, marks, shape, bad, LEAST_FOR_DEGREE);
    note(made);
    return made.count;
}

void PatchState::note(const SwapsMade& made) {
    stars_known_ = made.stars_known;
    swaps += made.count;
    edge_changes += made.count;
}

void PatchState::note_removed(int vertices) {
    stars_known_ = stars_known_ && vertices == 0;
    collapses += vertices;
    edge_changes += vertices;
}

void PatchState::collapse() {
    if (stopped()) return;
    find_stars();
    note_removed(collapse_short_edges(t, frames, stars, marks, SHORTEST, FEW));
}

int PatchState::remove_at_border(double bad) {
    if (stopped() || shape.size() < t.region.size()) return 0;
    find_stars();
    const int made = surfmesh::remove_at_border(t, frames, stars, marks, shape, bad,
                                                filling_limits(asked(), LONGEST_UNSMOOTHED));
    note_removed(made);
    return made;
}

void PatchState::remove_worst(double least) {
    if (stopped() || shape.size() < t.region.size()) return;
    find_stars();
    note_removed(surfmesh::remove_worst(t, frames, stars, marks, shape, least,
                                        filling_limits(asked(), LONGEST)));
}

void PatchState::insert_at_worst(double least) {
    if (stopped() || shape.size() < t.region.size()) return;
    const Vertex first = surfmesh::insert_at_worst(t, frames, marks, shape, least);
    if (set_new(first) == 0) return;
    find_stars();
    const int removed = remove_bad_stars(t, frames, stars, marks, first, least);
    stars_known_ = removed == 0;
    splits -= removed;
    edge_changes += removed;
}

void PatchState::split(double longest) {
    if (stopped()) return;
    set_new(split_long_edges(t, frames, marks, longest));
}

int PatchState::split_farthest(std::span<const Triangle> triangles) {
    if (stopped()) return 0;
    return set_new(split_far_edges(t, frames, marks, triangles));
}

void PatchState::allow_splits() {
    frames.limits.most_vertices = most_vertices(t.xy.size(), is_anisotropic());
}

int PatchState::hold_growth(bool around_all) {
    if (!asked().slope || stopped()) return 0;
    find_stars();
    return grade_scales(t, frames, stars, marks, *asked().slope, around_all);
}

void PatchState::restore_nodes() {
    if (!asked().slope || asked().is_width || asked().keeps_lowered || is_anisotropic() ||
        stopped())
        return;
    find_stars();
    restore_scales(t, frames, stars, nodes_.vertex, *asked().slope);
}

void PatchState::end_passes() {
    const bool is_anisotropic = frames.is_anisotropic;
    Array<double> scale = std::move(frames.scale);
    frames = SurfaceFrames();
    frames.scale = std::move(scale);
    frames.is_anisotropic = is_anisotropic;
    stars = Stars();
    stars_known_ = false;
    marks = VertexMarks();
    shape = Array<double>();
    moved = Array<Vertex>();
}

/// Set the frames of vertices from number ``first`` on; returns how many there are.
int PatchState::set_new(Vertex first) {
    const Array<Vertex> added = vertices_from(first, t.vertices());
    if (added.empty()) return 0;
    set_frames(added);
    stars_known_ = false;
    splits += static_cast<int>(added.size());
    edge_changes += static_cast<std::int64_t>(added.size());
    return static_cast<int>(added.size());
}

}  // namespace surfmesh
