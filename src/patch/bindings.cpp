#include <nanobind/stl/optional.h>
#include <nanobind/stl/pair.h>

#include <cmath>
#include <memory>
#include <optional>

#include "binding/arrays.hpp"
#include "patch/mapping.hpp"
#include "patch/patch_state.hpp"
#include "patch/schedule.hpp"
#include "patch/size_requests.hpp"
#include "surfaces/callback_surface.hpp"

namespace surfmesh::binding {

void bind_results(nb::module_& m);
void bind_accuracy(nb::module_& m);
void bind_seams(nb::module_& m);
void bind_patch_mesh(nb::module_& m);

namespace {

using Numbers = Vector<std::int32_t>;

/// A callable of Python that is told of each pass, and what it raised.
struct PassHook {
    nb::object call;
    std::exception_ptr raised;

    bool operator()() {
        const nb::gil_scoped_acquire held;
        try {
            call();
            return true;
        } catch (...) {
            raised = std::current_exception();
            return false;
        }
    }
};

/// A patch that is driven from Python, pass by pass or as a whole.
struct BoundPatch {
    const Surface& surface;
    std::shared_ptr<PassHook> hook;
    PatchState state;

    /// Do something with the state, the interpreter released; raise what stopped it.
    template <class Work>
    auto run(Work work) {
        require_rows(state.frames.point.size(), state.t.xy.size(), "frames");
        require_rows(state.marks.active.size(), state.t.xy.size(), "marks");
        auto found = [&] {
            const nb::gil_scoped_release released;
            return work(state);
        }();
        raise_if_stopped();
        return found;
    }
    /// The same of what finds nothing.
    template <class Pass>
    void run_pass(Pass pass) {
        run([&](PatchState& s) {
            pass(s);
            return true;
        });
    }
    void raise_if_stopped() {
        if (state.status() == PatchStatus::SURFACE_FAILED)
            raise_failure(surface, state.surface().status());
        if (state.status() == PatchStatus::CANCELLED) std::rethrow_exception(hook->raised);
    }
};

void require_domain(const Triangulation& t) {
    if (!t.has_segments() && t.triangles() > 0)
        throw nb::value_error("the triangulation has no ``fixed``");
    for (HalfEdge e = 0; e < 3 * t.triangles(); ++e)
        if (t.tri[e] == NIL && t.region[e / 3] != DEAD)
            throw nb::value_error("the triangulation has a ghost triangle");
}

BoundaryNodes nodes_of(const Triangulation& t, const Numbers& vertex, const Numbers& same,
                       const Numbers& on_kinks, const std::optional<Points3>& points) {
    require_rows(same.shape(0), vertex.shape(0), "same");
    require_indices(rows<Vertex>(vertex), t.xy.size(), "node");
    require_indices(rows<Vertex>(same), t.xy.size(), "same");
    require_indices(rows<Vertex>(on_kinks), t.xy.size(), "on_kinks");
    if (points) require_rows(points->shape(0), vertex.shape(0), "points");
    return {Array<Vertex>(rows<Vertex>(vertex)), Array<Vertex>(rows<Vertex>(same)),
            Array<Vertex>(rows<Vertex>(on_kinks)),
            points ? Array<Point3>(rows<Point3>(*points)) : Array<Point3>()};
}

void construct(BoundPatch* made, Triangulation& t, const Numbers& node, const Numbers& same,
               const Numbers& on_kinks, const std::optional<Points3>& points,
               const Surface& surface, const Chart& chart, const Background& background,
               std::optional<double> chord, std::optional<double> angle, double min_size,
               std::optional<double> slope, const nb::object& before_pass) {
    require_domain(t);
    BoundaryNodes nodes = nodes_of(t, node, same, on_kinks, points);
    std::shared_ptr<PassHook> hook;
    if (!before_pass.is_none()) hook = std::make_shared<PassHook>(PassHook{before_pass, {}});
    PatchSetting setting{surface, chart, background, {chord, angle, min_size, slope}, {}};
    if (hook) setting.before_pass = [hook] { return (*hook)(); };
    auto patch = [&] {
        const nb::gil_scoped_release released;
        return BoundPatch{surface, hook, PatchState(t, std::move(nodes), setting)};
    }();
    patch.raise_if_stopped();
    new (made) BoundPatch(std::move(patch));
}

/// Passes that move vertices and keep all triangles.
void bind_moves(nb::class_<BoundPatch>& c) {
    c.def("find_stars", [](BoundPatch& p) { p.run_pass([](PatchState& s) { s.find_stars(); }); });
    c.def(
        "set_frames",
        [](BoundPatch& p, const Numbers& vertices) {
            require_indices(rows<Vertex>(vertices), p.state.t.xy.size(), "vertices");
            p.run_pass([&](PatchState& s) { s.set_frames(rows<Vertex>(vertices)); });
        },
        nb::arg("vertices"), "Put vertices (n,) back on the surface, with their exact metric.");
    c.def(
        "smooth",
        [](BoundPatch& p, double stiffness) {
            return p.run([&](PatchState& s) { return s.smooth(stiffness); });
        },
        nb::arg("stiffness") = STIFFNESS,
        "Move every active vertex by one Newton step; returns how many have moved.");
    c.def(
        "raise_worst",
        [](BoundPatch& p, double least) {
            p.run_pass([&](PatchState& s) { s.raise_worst(least); });
        },
        nb::arg("least"),
        "Raise the smallest alpha around triangles below ``least`` by moves of their free "
        "corners.");
}

/// Passes that swap edges.
void bind_swaps(nb::class_<BoundPatch>& c) {
    c.def(
        "swap",
        [](BoundPatch& p, double good) { p.run_pass([&](PatchState& s) { s.swap(good); }); },
        nb::arg("good") = GOOD_SHAPE,
        "Swap edges of triangles below the alpha ``good`` while that raises the smaller one.");
    c.def(
        "swap_for_degree",
        [](BoundPatch& p) { p.run_pass([](PatchState& s) { s.swap_for_degree(); }); },
        "Swap edges that bring the degrees of their four vertices nearer to six.");
    c.def(
        "swap_at_border",
        [](BoundPatch& p, double bad) {
            return p.run([&](PatchState& s) { return s.swap_at_border(bad); });
        },
        nb::arg("bad"),
        "The same at triangles below the alpha ``bad`` on straight borders, where vertices of "
        "three triangles are regular. Returns the swaps made.");
}

/// Passes that take vertices away or add some.
void bind_removals_and_splits(nb::class_<BoundPatch>& c) {
    c.def(
        "remove_at_border",
        [](BoundPatch& p, double bad) {
            return p.run([&](PatchState& s) { return s.remove_at_border(bad); });
        },
        nb::arg("bad"),
        "Remove vertices beside straight borders, of triangles below the alpha ``bad``, without "
        "which degrees are nearer to regular. Returns how many went.");
    c.def(
        "collapse", [](BoundPatch& p) { p.run_pass([](PatchState& s) { s.collapse(); }); },
        "Remove interior vertices with a short edge, or with few triangles.");
    c.def(
        "remove_worst",
        [](BoundPatch& p, double least) {
            p.run_pass([&](PatchState& s) { s.remove_worst(least); });
        },
        nb::arg("least"),
        "Remove corners of triangles below ``least`` where that raises the smallest alpha around.");
    c.def(
        "insert_at_worst",
        [](BoundPatch& p, double least) {
            p.run_pass([&](PatchState& s) { s.insert_at_worst(least); });
        },
        nb::arg("least"),
        "Add vertices at triangles below ``least`` where that raises the smallest alpha around.");
    c.def(
        "split",
        [](BoundPatch& p, double longest) { p.run_pass([&](PatchState& s) { s.split(longest); }); },
        nb::arg("longest") = LONGEST, "Split interior edges of active vertices that are longer.");
    c.def(
        "split_farthest",
        [](BoundPatch& p, const Numbers& triangles) {
            require_indices(rows<Triangle>(triangles), p.state.t.region.size(), "triangles");
            return p.run(
                [&](PatchState& s) { return s.split_farthest(rows<Triangle>(triangles)); });
        },
        nb::arg("triangles"),
        "Split the edge of each of the triangles (n,) that lies farthest from the surface; "
        "returns how many were split.");
}

MappedPatch mapped(BoundPatch& p, const Points2& node_uv, const Numbers& node,
                   const Matrix<std::int32_t, 2>& segments, const Vector<std::int64_t>& identity) {
    require_rows(node_uv.shape(0), p.state.nodes().vertex.size(), "node_uv");
    require_rows(identity.shape(0), node.shape(0), "identity");
    require_indices(rows<std::int64_t>(identity), node.shape(0), "identity");
    require_indices(std::span<const std::int32_t>(segments.data(), segments.size()), node.shape(0),
                    "segments");
    for (const Vertex v : rows<Vertex>(node))
        if (v < NIL || v >= p.state.t.vertices())
            throw nb::value_error("node has a vertex that is out of range");
    return p.run([&](PatchState& s) {
        return map_to_space(
            s, rows<Point2>(node_uv),
            {rows<Vertex>(node), rows<Segment>(segments), rows<std::int64_t>(identity)});
    });
}

/// A property that gives a member of the state, which lives as long as the patch.
template <class T>
void bind_member(nb::class_<BoundPatch>& c, const char* name, T PatchState::* member) {
    c.def_prop_ro(
        name, [member](BoundPatch& p) -> T& { return p.state.*member; },
        nb::rv_policy::reference_internal);
}

void bind_state(nb::class_<BoundPatch>& c) {
    c.def("__init__", &construct, nb::arg("t"), nb::arg("node"), nb::arg("same"),
          nb::arg("on_kinks"), nb::arg("points").none(), nb::arg("surface"), nb::arg("chart"),
          nb::arg("background"), nb::arg("chord") = nb::none(), nb::arg("angle") = nb::none(),
          nb::arg("min_size") = 0.0, nb::arg("slope") = nb::none(),
          nb::arg("before_pass") = nb::none(), nb::keep_alive<1, 2>(), nb::keep_alive<1, 7>(),
          nb::keep_alive<1, 8>(), nb::keep_alive<1, 9>(),
          "t: of the domain, changed in place. node, same (k,): vertices of the boundary's nodes, "
          "and of those they coincide with in space. on_kinks (j,): vertices where the surface has "
          "two normals. points (k, 3): where the nodes lie; None: on the surface.\nchord (model "
          "units), angle (degrees): what is asked for. before_pass: called before each pass of "
          "smoothing; may raise to stop the work.");
    c.def_prop_ro(
        "t", [](BoundPatch& p) -> Triangulation& { return p.state.t; },
        nb::rv_policy::reference_internal, "The triangulation of the domain.");
    bind_member(c, "frames", &PatchState::frames);
    bind_member(c, "stars", &PatchState::stars);
    bind_member(c, "marks", &PatchState::marks);
    c.def_prop_ro(
        "shape", [](const BoundPatch& p) { return view(p.state.shape); }, nb::rv_policy::automatic,
        "(triangles,) alpha, as swaps have last seen it");
    c.def_prop_ro("swaps", [](const BoundPatch& p) { return p.state.swaps; });
    c.def_prop_ro("collapses", [](const BoundPatch& p) { return p.state.collapses; });
    c.def_prop_ro("splits", [](const BoundPatch& p) { return p.state.splits; });
    c.def_prop_ro("passes", [](const BoundPatch& p) { return p.state.passes; });
}

void bind_schedule(nb::class_<BoundPatch>& c) {
    c.def("mapped", &mapped, nb::arg("node_uv"), nb::arg("node"), nb::arg("segments"),
          nb::arg("identity"),
          "The triangles in space, seams identified; no pass may come after.\n\nnode_uv: (j, 2) of "
          "the nodes that have a vertex, to the last bit. node (k,), segments (s, 2), identity "
          "(k,): of boundary loops, "
          "the vertex of each node or NIL, pairs of nodes, and for each node the first that is the "
          "same point in space; empty where nothing is identified.");
    c.def(
        "optimise",
        [](BoundPatch& p, bool first) {
            return p.run([&](PatchState& s) { return optimise(s, first); });
        },
        nb::arg("first") = true,
        "Optimise in place; what is good already is left alone. Returns what is left.\n\n"
        "first: the sizes come from no earlier round, and one with finer sizes may follow.");
    c.def(
        "size_requests",
        [](BoundPatch& p, const Unmended& left,
           const std::optional<Vector<std::uint8_t>>& off_surface) {
            for (const Triangle k : left.far)
                if (k >= p.state.t.triangles()) throw nb::value_error("left is of another patch");
            for (const Triangle k : left.folded)
                if (k >= p.state.t.triangles()) throw nb::value_error("left is of another patch");
            for (const auto [a, b] : left.dihedrals.triangles)
                if (std::max(a, b) >= p.state.t.triangles())
                    throw nb::value_error("left is of another patch");
            if ((left.far.size() > 0 && !p.state.asked().chord) ||
                (left.dihedrals.angles.size() > 0 && !p.state.asked().angle))
                throw nb::value_error("left is of another patch");
            std::span<const std::uint8_t> off;
            if (off_surface) {
                require_rows(off_surface->shape(0), p.state.nodes().vertex.size(), "off_surface");
                off = rows<std::uint8_t>(*off_surface);
            }
            return p.run([&](PatchState& s) { return size_requests(s, left, off, true); });
        },
        nb::arg("left"), nb::arg("off_surface") = nb::none(),
        "Upper bounds of the size under which what is ``left`` would be right.\n\n"
        "off_surface: (k,) marks of the nodes that lie off the surface themselves: for the "
        "triangles at them smaller sizes are no help.");
}

}  // namespace

void bind_patch(nb::module_& m) {
    m.doc() = "A whole (u, v) domain and its size field become triangles in one call.";
    m.attr("SHORTEST") = SHORTEST;
    m.attr("LONGEST") = LONGEST;
    bind_accuracy(m);
    bind_seams(m);
    bind_results(m);
    nb::class_<BoundPatch> patch(m, "PatchState",
                                 "A triangulated domain with its surface frames, and the passes "
                                 "of the optimiser on it.");
    bind_state(patch);
    bind_moves(patch);
    bind_swaps(patch);
    bind_removals_and_splits(patch);
    bind_schedule(patch);
    bind_patch_mesh(m);
}

}  // namespace surfmesh::binding
