#include "insertion/inside.hpp"

namespace surfmesh {

Recovery grow_inside(Triangulation& t, std::span<const HalfEdge> edge) {
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
