#include "insertion/inside.hpp"

#include <algorithm>

#include "values/threads.hpp"

namespace surfmesh {
namespace {

constexpr std::size_t REGIONS_TOGETHER = 1 << 16;  // triangles that are marked together
constexpr std::size_t OUTSIDE_PART = 4;  // one triangle of so many: more are not looked at outside

/// The same from the other sides of the edges: they see little of a domain that fills its box. False
/// where that does not tell: the ghosts are not reached, or an edge is, or too much is.
bool grow_outside(Triangulation& t, std::span<const HalfEdge> edge) {
    for_each_block(t.region.size(), REGIONS_TOGETHER, [&](std::size_t first, std::size_t last) {
        for (Region* region = t.region.data() + first; region < t.region.data() + last; ++region)
            if (*region != DEAD) *region = INSIDE;
    });
    Array<Triangle> reached;
    const auto reach = [&](Triangle k) {
        if (t.region[k] != INSIDE) return;
        t.region[k] = OUTSIDE;
        reached.push_back(k);
    };
    bool has_ghosts = false;
    for (const HalfEdge e : edge) reach(t.adj[e] / 3);
    for (std::size_t n = 0; n < reached.size(); ++n) {
        if (n > t.region.size() / OUTSIDE_PART) return false;
        const Triangle triangle = reached.data()[n];
        for (HalfEdge e = 3 * triangle; e < 3 * triangle + 3; ++e) {
            has_ghosts = has_ghosts || t.tri[e] < 0;
            if (t.fixed[e] == 0) reach(t.adj[e] / 3);
        }
    }
    const auto is_inside = [&](HalfEdge e) { return t.region[e / 3] == INSIDE; };
    return has_ghosts && std::all_of(edge.begin(), edge.end(), is_inside);
}

}  // namespace

Recovery grow_inside(Triangulation& t, std::span<const HalfEdge> edge) {
    if (grow_outside(t, edge)) return Recovery::finished;
    for (Region& region : t.region)
        if (region != DEAD) region = OUTSIDE;
    Array<Triangle> stack;
    const auto reach = [&](Triangle k) {
        if (t.region[k] != OUTSIDE) return;
        t.region[k] = INSIDE;
        stack.push_back(k);
    };
    for (const HalfEdge e : edge) reach(e / 3);
    while (!stack.empty()) {
        const Triangle triangle = stack.pop_back();
        for (HalfEdge e = 3 * triangle; e < 3 * triangle + 3; ++e) {
            if (t.tri[e] < 0) return Recovery::leak;
            if (t.fixed[e] == 0) reach(t.adj[e] / 3);
        }
    }
    return Recovery::finished;
}

Patches label_patches(std::span<const HalfEdge> adj, std::span<const std::uint8_t> fixed,
                      std::span<const Region> region) {
    Patches patches{Array<std::int32_t>(region.size(), NIL)};
    Array<Triangle> stack;
    for (std::size_t k = 0; k < region.size(); ++k) {
        if (patches.label[k] != NIL || region[k] == DEAD) continue;
        patches.label[k] = patches.count;
        stack.push_back(static_cast<Triangle>(k));
        while (!stack.empty()) {
            const Triangle triangle = stack.pop_back();
            for (HalfEdge e = 3 * triangle; e < 3 * triangle + 3; ++e) {
                if (adj[e] < 0 || fixed[e] != 0) continue;
                std::int32_t& label = patches.label[adj[e] / 3];
                if (label != NIL) continue;
                label = patches.count;
                stack.push_back(adj[e] / 3);
            }
        }
        ++patches.count;
    }
    return patches;
}

}  // namespace surfmesh
