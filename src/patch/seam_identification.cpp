#include "patch/seam_identification.hpp"

#include <algorithm>
#include <atomic>
#include <utility>
#include <vector>

#include "values/threads.hpp"

namespace surfmesh {
namespace {

constexpr std::size_t SEEN_TOGETHER = 1 << 15;  // triangles or vertices looked at together

/// An edge without direction: its smaller end comes first.
using Edge = std::pair<std::int64_t, std::int64_t>;

Edge edge_of(std::int64_t a, std::int64_t b) { return {std::min(a, b), std::max(a, b)}; }

/// Sort and count: how many there are without those that are there twice.
template <class Value>
std::int64_t distinct(std::vector<Value>& values) {
    std::sort(values.begin(), values.end());
    values.erase(std::unique(values.begin(), values.end()), values.end());
    return static_cast<std::int64_t>(values.size());
}

/// What identification must make of a boundary.
struct Expected {
    std::int64_t joined = 0;        // nodes that are identified with others
    std::int64_t collapsed = 0;     // segments that become points
    std::int64_t euler_change = 0;  // of Euler's number
};

Expected expected_of(const IdentifiedBoundary& boundary) {
    std::vector<std::int64_t> identities(boundary.identity.begin(), boundary.identity.end());
    Expected expected;
    expected.joined = static_cast<std::int64_t>(identities.size()) - distinct(identities);
    if (expected.joined == 0) return expected;
    std::vector<Edge> segments, pairs;
    // an edge inside is walked there and back: two segments of the loops, one of the domain
    for (const auto [a, b] : boundary.segments) segments.push_back(edge_of(a, b));
    distinct(segments);
    for (const auto& [a, b] : segments) {
        const std::int64_t start = boundary.identity[a], end = boundary.identity[b];
        if (start == end)
            ++expected.collapsed;
        else
            pairs.push_back(edge_of(start, end));
    }
    const auto before = static_cast<std::int64_t>(pairs.size());
    const std::int64_t identified = before - distinct(pairs);
    expected.euler_change = expected.collapsed + identified - expected.joined;
    return expected;
}

/// Vertices of a domain become points.
class Identification {
  public:
    Identification(const DomainTriangles& domain, const IdentifiedBoundary& boundary)
        : domain_(domain),
          expected_(expected_of(boundary)),
          same_(domain.vertices),
          is_joined_(domain.vertices, 0) {
        for (Vertex v = 0; v < domain.vertices; ++v) same_[v] = v;
        if (expected_.joined > 0) join(boundary);
    }

    SurfaceTriangles triangles() {
        number_points();
        if (expected_.joined == 0) {
            copy_triangles();
            return std::move(found_);
        }
        found_.triangles.reserve(domain_.tri.size());
        found_.corners.reserve(domain_.tri.size());
        for (std::size_t k = 0; k < domain_.region.size(); ++k)
            if (domain_.region[k] != DEAD) add_triangle(static_cast<Triangle>(k));
        check();
        return std::move(found_);
    }

  private:
    /// Nodes take the vertex of the first node that they coincide with.
    void join(const IdentifiedBoundary& boundary) {
        for (std::size_t k = 0; k < boundary.node.size(); ++k) {
            const Vertex v = boundary.node[k], first = boundary.node[boundary.identity[k]];
            if (v == NIL || first == NIL || v == first) continue;
            same_[v] = first;
            is_joined_[v] = is_joined_[first] = 1;
        }
    }

    /// Points are the vertices in use that stand for themselves, in their order.
    void number_points() {
        Array<std::uint8_t> used(domain_.vertices, 0);
        for_each_block(domain_.region.size(), SEEN_TOGETHER, [&](std::size_t k, std::size_t last) {
            for (; k < last; ++k) {
                if (domain_.region[k] == DEAD) continue;
                for (std::size_t e = 3 * k; e < 3 * k + 3; ++e)  // by several threads at once
                    std::atomic_ref(used[domain_.tri[e]]).store(1, std::memory_order_relaxed);
            }
        });
        used_ = std::count(used.begin(), used.end(), std::uint8_t{1});
        found_.vertex = collect_by_blocks<std::int64_t>(
            used.size(), SEEN_TOGETHER,
            [&](std::size_t first, std::size_t last, Array<std::int64_t>& found) {
                for (auto v = static_cast<Vertex>(first); v < static_cast<Vertex>(last); ++v)
                    if (used[v] && same_[v] == v) found.push_back(v);
            });
        point_.resize(domain_.vertices, NIL);
        for_each_block(found_.vertex.size(), SEEN_TOGETHER, [&](std::size_t n, std::size_t last) {
            for (; n < last; ++n) point_[found_.vertex.data()[n]] = static_cast<std::int32_t>(n);
        });
    }

    /// Those of a domain none of whose vertices coincide.
    void copy_triangles() {
        const Array<Triangle> live = collect_by_blocks<Triangle>(
            domain_.region.size(), SEEN_TOGETHER,
            [&](std::size_t first, std::size_t last, Array<Triangle>& found) {
                for (std::size_t k = first; k < last; ++k)
                    if (domain_.region[k] != DEAD) found.push_back(static_cast<Triangle>(k));
            });
        found_.triangles = Array<std::int32_t>::unfilled(3 * live.size());
        found_.corners = Array<std::int32_t>::unfilled(3 * live.size());
        for_each_block(live.size(), SEEN_TOGETHER, [&](std::size_t n, std::size_t last) {
            for (; n < last; ++n)
                for (std::size_t corner = 0; corner < 3; ++corner) {
                    const std::size_t to = 3 * n + corner;
                    const Vertex v =
                        domain_.tri[3 * static_cast<std::size_t>(live.data()[n]) + corner];
                    found_.triangles.data()[to] = point_[v];
                    found_.corners.data()[to] = v;
                }
        });
    }

    [[nodiscard]] std::int32_t point(HalfEdge e) const { return point_[same_[domain_.tri[e]]]; }

    void add_triangle(Triangle k) {
        ++live_;
        const HalfEdge e = 3 * k;
        for (HalfEdge f = e; f < e + 3; ++f) border_ += domain_.adj[f] < 0;
        const std::int32_t a = point(e), b = point(e + 1), c = point(e + 2);
        if (a == b || b == c || c == a) {
            ++lost_;
            for (const std::int32_t corner : {a, b, c}) lost_points_.push_back(corner);
            return;
        }
        for (const std::int32_t corner : {a, b, c}) found_.triangles.push_back(corner);
        for (HalfEdge f = e; f < e + 3; ++f) {
            found_.corners.push_back(domain_.tri[f]);
            count_edge(f);
        }
    }

    /// An edge away from the seams has two half-edges, or one on the border. Of the others all are
    /// kept: identification may lay any of them on each other.
    void count_edge(HalfEdge e) {
        const Vertex start = domain_.tri[e], end = domain_.tri[next_half_edge(e)];
        if (is_joined_[start] || is_joined_[end])
            at_seams_.push_back(edge_of(point(e), point(next_half_edge(e))));
        else
            edges_ += domain_.adj[e] < e;
    }

    /// Find the points where there is no surface.
    void check() {
        std::vector<std::int64_t> bad;
        if (lost_ != expected_.collapsed) bad.assign(lost_points_.begin(), lost_points_.end());
        std::sort(at_seams_.begin(), at_seams_.end());
        for (std::size_t k = 0; k + 2 < at_seams_.size(); ++k)
            if (at_seams_[k] == at_seams_[k + 2]) {
                bad.push_back(at_seams_[k].first);
                bad.push_back(at_seams_[k].second);
            }
        edges_ += distinct(at_seams_);
        if (bad.empty() && euler() != euler_of_domain() + expected_.euler_change)
            for (std::size_t k = 0; k < found_.vertex.size(); ++k)
                bad.push_back(static_cast<std::int64_t>(k));
        distinct(bad);
        found_.non_manifold = Array<std::int64_t>(std::span<const std::int64_t>(bad));
    }

    /// Vertices - edges + triangles.
    [[nodiscard]] std::int64_t euler() const {
        return static_cast<std::int64_t>(found_.vertex.size()) - edges_ + (live_ - lost_);
    }
    /// The same before: the border has as many edges as half-edges.
    [[nodiscard]] std::int64_t euler_of_domain() const {
        return used_ - (3 * live_ + border_) / 2 + live_;
    }

    const DomainTriangles& domain_;
    Expected expected_;
    Array<Vertex> same_;             // of the vertices: the one that stands for the point
    Array<std::uint8_t> is_joined_;  // of the vertices: does another coincide with it?
    Array<std::int32_t> point_;      // of the vertices, or NIL
    SurfaceTriangles found_;
    std::vector<std::int32_t> lost_points_;
    std::vector<Edge> at_seams_;
    std::int64_t live_ = 0, lost_ = 0, border_ = 0, used_ = 0, edges_ = 0;
};

}  // namespace

SurfaceTriangles identify_seams(const DomainTriangles& domain, const IdentifiedBoundary& boundary) {
    return Identification(domain, boundary).triangles();
}

}  // namespace surfmesh
