#include "optimisation/scale_gradation.hpp"

#include <algorithm>
#include <utility>

#include "optimisation/marked_triangles.hpp"
#include "values/threads.hpp"

namespace surfmesh {
namespace {

constexpr int SWEEPS = 20;       // at most: sizes spread by an edge and more in each
constexpr double BEYOND = 1.08;  // times the slope: sizes are not lowered for less
constexpr double KEPT = 1.02;    // and then to this: what is lowered lowers its neighbours
constexpr std::size_t SWEPT_TOGETHER = 1 << 14;  // triangles looked at together
constexpr double LOWERED = 0.999;                // a scale below it is none of rounding

/// The factor on the sizes of b that lets them grow from a by no more than the slope; 1 where they
/// hardly do.
double factor_on(const SurfaceFrames& s, Vertex a, Vertex b, double slope) {
    const Point3 step = s.point[b] - s.point[a];
    double of_a = s.size[a], of_b = s.size[b], length = 0.0;
    if (s.is_anisotropic) {
        const Point3 at_a = apply(s.metric_root[a], step), at_b = apply(s.metric_root[b], step);
        const double square_a = dot(at_a, at_a), square_b = dot(at_b, at_b);
        if (square_a <= square_b) return 1.0;  // no larger at b
        length = norm(step);
        of_a = length / std::sqrt(square_a);
        of_b = length / std::sqrt(square_b);
    } else {
        const double most = BEYOND * slope, above = of_b - of_a;
        if (!(above > 0.0) || above * above <= most * most * dot(step, step)) return 1.0;
        length = norm(step);
    }
    const double rise = slope * length;
    if (!(length > 0.0)) return 1.0;
    return of_b > of_a + BEYOND * rise ? (of_a + KEPT * rise) / of_b : 1.0;
}

/// Call ``visit`` with the ends of the edges of triangle k, the way that it has them; the other way
/// too where no other triangle has it.
template <class Visit>
void for_each_way(const Triangulation& t, Triangle k, Visit visit) {
    for (HalfEdge e = 3 * k; e < 3 * k + 3; ++e) {
        const Vertex a = t.tri[e], b = t.tri[next_half_edge(e)];
        visit(a, b);
        if (t.adj[e] < 0) visit(b, a);
    }
}

/// Of triangles in their order those that a sweep looks at: across which ``factor`` would change a
/// size, as all are when it begins, and from there on those at vertices whose sizes it changes.
///
/// Threads find that of many, so that one has few left to sweep over in turn; one thread alone
/// sweeps over all of them, and asks nothing before.
class SweptTriangles {
  public:
    SweptTriangles(const Triangulation& t, const Stars& stars, const Array<Triangle>& all)
        : t_(t), stars_(stars), all_(all) {}

    template <class Factor>
    void find(const Array<std::uint8_t>& from, const Factor& factor) {
        if (allowed_threads() < 2) return;
        open_ = Array<std::uint8_t>::unfilled(all_.size());
        for_each_block(all_.size(), SWEPT_TOGETHER, [&](std::size_t first, std::size_t last) {
            for (std::size_t i = first; i < last; ++i) {
                bool is_open = false;
                for_each_way(t_, all_.data()[i], [&](Vertex a, Vertex b) {
                    is_open = is_open || (from[a] != 0 && factor(a, b) != 1.0);
                });
                open_.data()[i] = is_open;
            }
        });
    }
    /// The first place from i on, or the end.
    [[nodiscard]] std::int32_t next(std::int32_t i) const {
        return open_.empty() ? i : next_marked(open_, i, static_cast<std::int32_t>(open_.size()));
    }
    /// The size of v has changed.
    void open_at(Vertex v) {
        if (open_.empty()) return;
        std::int32_t count = 0;
        for_each_in_fan(t_, stars_.start[v], [&](HalfEdge e) {
            const Triangle* const place = std::lower_bound(all_.begin(), all_.end(), e / 3);
            if (place != all_.end() && *place == e / 3) open_[place - all_.begin()] = 1;
            ++count;
        });
        if (count != stars_.degree[v]) open_.fill(1);  // two borders meet there: not all are known
    }

  private:
    const Triangulation& t_;
    const Stars& stars_;
    const Array<Triangle>& all_;
    Array<std::uint8_t> open_;  // of all; empty where it looks at each
};

/// Sweeps over the triangles at vertices whose sizes have changed in the sweep before.
///
/// ``factor(a, b)``: on the size of b, by that of a, whose size has changed; 1 for no change.
/// ``change(b, factor)`` makes it.
template <class Factor, class Change>
void spread_scales(const Triangulation& t, const Stars& stars, Array<std::uint8_t> from,
                   const Factor& factor, const Change& change) {
    Array<Triangle> around = triangles_at(t, &stars, from);
    for (int sweep = 0; sweep < SWEEPS; ++sweep) {
        SweptTriangles swept(t, stars, around);
        swept.find(from, factor);
        Array<std::uint8_t> is_changed(t.xy.size(), 0);
        bool changes = false;
        const auto end = static_cast<std::int32_t>(around.size());
        for (std::int32_t i = swept.next(0); i < end; i = swept.next(i + 1)) {
            for_each_way(t, around[i], [&](Vertex a, Vertex b) {
                const double by = from[a] == 0 ? 1.0 : factor(a, b);
                if (by == 1.0) return;
                change(b, by);
                is_changed[b] = 1;
                changes = true;
                swept.open_at(b);
            });
        }
        if (!changes) return;
        around = triangles_at(t, &stars, is_changed);
        from = std::move(is_changed);
    }
}

/// Raise sizes that were lowered, around vertices that are marked and from there on, until none is
/// smaller than its neighbour's less the slope times the way; none above that of the size field.
void raise_towards(const Triangulation& t, SurfaceFrames& s, const Stars& stars,
                   Array<std::uint8_t> from, double slope) {
    const auto factor = [&](Vertex a, Vertex b) {
        if (!(s.scale[b] < LOWERED)) return 1.0;
        const double least = s.size[a] - slope * norm(s.point[b] - s.point[a]);
        if (!(s.size[b] < LOWERED * least)) return 1.0;
        return std::min(least / s.size[b], 1.0 / s.scale[b]);
    };
    const auto raise = [&](Vertex b, double by) { shorten(s, b, by); };
    spread_scales(t, stars, std::move(from), factor, raise);
}

}  // namespace

int grade_scales(const Triangulation& t, SurfaceFrames& s, const Stars& stars, VertexMarks& marks,
                 double slope, bool around_all) {
    Array<std::uint8_t> found(t.xy.size(), 0);
    auto from = Array<std::uint8_t>::unfilled(t.xy.size());
    for_each_block(from.size(), SWEPT_TOGETHER, [&](std::size_t first, std::size_t last) {
        for (std::size_t v = first; v < last; ++v) from[v] = around_all || s.scale[v] < LOWERED;
    });
    const auto factor = [&](Vertex a, Vertex b) {
        const double by = factor_on(s, a, b, slope);
        return by < 1.0 ? by : 1.0;
    };
    const auto lower = [&](Vertex b, double by) {
        shorten(s, b, by);
        marks.active[b] = found[b] = 1;
    };
    spread_scales(t, stars, std::move(from), factor, lower);
    return static_cast<int>(std::count(found.begin(), found.end(), 1));
}

void restore_scales(const Triangulation& t, SurfaceFrames& s, const Stars& stars,
                    std::span<const Vertex> vertices, double slope) {
    Array<double> least(t.xy.size(), 0.0);  // what the restored are lowered to; 0 for all others
    Array<std::uint8_t> is_restored(t.xy.size(), 0);
    for (const Vertex v : vertices) {
        if (!(s.scale[v] < LOWERED)) continue;
        is_restored[v] = 1;
        least[v] = s.size[v];
        shorten(s, v, 1.0 / s.scale[v]);
    }
    const Array<Triangle> around = triangles_at(t, &stars, is_restored);
    raise_towards(t, s, stars, std::move(is_restored), slope);
    for (int sweep = 0; sweep < SWEEPS; ++sweep) {
        bool changes = false;
        const auto hold = [&](Vertex a, Vertex b) {
            if (!(least[b] > 0.0)) return;
            const double grown = s.size[a] + slope * norm(s.point[b] - s.point[a]);
            const double size = std::max(grown, least[b]);
            if (!(size < s.size[b])) return;
            shorten(s, b, size / s.size[b]);
            changes = true;
        };
        for (const Triangle k : around) for_each_way(t, k, hold);
        if (!changes) break;
    }
}

}  // namespace surfmesh
