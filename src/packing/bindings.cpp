#include <nanobind/stl/array.h>
#include <nanobind/stl/pair.h>
#include <nanobind/stl/tuple.h>

#include <array>
#include <cmath>
#include <tuple>

#include "binding/arrays.hpp"
#include "binding/calls_back.hpp"
#include "packing/packing_in_halves.hpp"

namespace surfmesh::binding {

template <>
struct Row<FrontLink> : RowOf<std::int32_t, 3> {};

namespace {

using Box = std::array<double, 4>;
using Place = std::array<double, 2>;

PackingLimits limits_of(const Box& box, const Place& origin, std::int64_t wanted, double distance) {
    for (const double x : {box[0], box[1], box[2], box[3], origin[0], origin[1]})
        if (!std::isfinite(x)) throw nb::value_error("box and origin are to be finite");
    if (!(distance > 0.0)) throw nb::value_error("distance is to be positive");
    return {{origin[0], origin[1]}, {box[0], box[1]}, {box[2], box[3]}, distance, wanted};
}

Watch watch_of(CallsBack& calls, const nb::object& watch) {
    return [&calls, &watch](Vertex circles) {
        return calls.run([&] {
            if (!watch.is_none()) watch(circles);
        });
    };
}

Packing packed(const Background& background, const Box& box, const Place& origin,
               std::size_t expected, std::int64_t wanted, double distance,
               const nb::object& watch) {
    const PackingLimits limits = limits_of(box, origin, wanted, distance);
    CallsBack calls;
    Packing made;
    {
        const nb::gil_scoped_release released;
        made = pack({background}, limits, expected, watch_of(calls, watch));
    }
    calls.finish();
    return made;
}

Packing packed_box(const Background& background, const Box& box, std::size_t expected,
                   const nb::object& watch) {
    const PackingLimits limits = limits_of(box, {0.0, 0.0}, 1, 1.0);
    CallsBack calls;
    Packing made;
    {
        const nb::gil_scoped_release released;
        made = pack_box({background}, limits.low, limits.high, expected, watch_of(calls, watch));
    }
    calls.finish();
    return made;
}

/// Append what ``draw(count)`` gives to the radii drawn so far.
void draw_more(const nb::object& draw, std::size_t count, Array<double>& drawn) {
    Vector<double> given;
    if (!nb::try_cast(draw(count), given)) throw nb::type_error("draw gives no array of radii");
    require_rows(given.shape(0), count, "what draw gives");
    for (std::size_t k = 0; k < count; ++k) {
        if (!(given(k) > 0.0 && std::isfinite(given(k))))
            throw nb::value_error("draw gives a radius that is not positive");
        drawn.push_back(given(k));
    }
}

Packing packed_discs(const nb::object& draw, const Box& box, const Place& origin,
                     std::size_t expected, std::int64_t wanted, double distance,
                     const nb::object& watch) {
    const PackingLimits limits = limits_of(box, origin, wanted, distance);
    CallsBack calls;
    const Draw draw_some = [&](std::size_t count, Array<double>& drawn) {
        return calls.run([&] { draw_more(draw, count, drawn); });
    };
    Packing made;
    {
        const nb::gil_scoped_release released;
        made = pack_discs(draw_some, limits, expected, watch_of(calls, watch));
    }
    calls.finish();
    return made;
}

void bind_status(nb::module_& m) {
    nb::enum_<PackingStatus>(m, "PackingStatus", "How a packing ended.")
        .value("FINISHED", PackingStatus::finished,
               "The front has left the box, or the wanted number of circles is reached.")
        .value("BAD_START", PackingStatus::bad_start, "There are no three circles at the origin.")
        .value("STUCK", PackingStatus::stuck, "No edge of the front can be advanced.")
        .value("TOO_MANY", PackingStatus::too_many, "More circles than can be numbered.")
        .value("STOPPED", PackingStatus::stopped, "Whoever watches wanted no more.");
}

void bind_heap(nb::module_& m) {
    nb::class_<EdgeHeap> c(m, "EdgeHeap", "Directed edges (a, b) with a key, smallest first.");
    c.def(nb::init<>());
    c.def("__len__", &EdgeHeap::size);
    c.def(
        "push", [](EdgeHeap& heap, double key, Vertex a, Vertex b) { heap.push({key, {a, b}}); },
        nb::arg("key"), nb::arg("a"), nb::arg("b"));
    c.def(
        "pop",
        [](EdgeHeap& heap) {
            if (heap.empty()) throw nb::index_error("the heap is empty");
            const auto [key, edge] = heap.pop();
            return std::tuple(key, edge.a, edge.b);
        },
        "Remove and return the smallest (key, a, b).");
}

void bind_packing_class(nb::module_& m) {
    nb::class_<Packing> c(m, "Packing",
                          "Circles, their triangulation of the whole plane, and the front.");
    c.def_prop_ro(
        "t", [](Packing& p) -> Triangulation& { return p.t; },
        "Triangulation of the centres: region DONE within the front, TODO outside.");
    c.def_prop_ro(
        "front", [](const Packing& p) { return view(p.front.links); }, nb::rv_policy::automatic,
        "(vertices, 3) int32: next and previous circle on the front, and the done half-edge from "
        "the circle to the next; NIL off the front");
    c.def_prop_ro(
        "radius", [](const Packing& p) { return view(p.radius); }, nb::rv_policy::automatic,
        "(vertices,): got over wanted radius");
    c.def_prop_ro(
        "drawn", [](const Packing& p) { return view(p.drawn); }, nb::rv_policy::automatic,
        "(at least vertices,) the radius each circle was to have; (0,) where a field says it");
    c.def_prop_ro(
        "status", [](const Packing& p) { return p.end.status; }, "How the packing ended.");
    c.def_prop_ro(
        "place", [](const Packing& p) { return std::pair(p.end.place.x, p.end.place.y); },
        "Where it ended, if not by its limits: the origin or the middle of an edge of the front.");
    const auto bind_count = [&c](const char* name, std::int64_t PackingCounts::* member,
                                 const char* doc) {
        c.def_prop_ro(name, [member](const Packing& p) { return p.counts.*member; }, doc);
    };
    bind_count("steps", &PackingCounts::steps, "Iterations of fits to two and three circles.");
    bind_count("fits", &PackingCounts::fits, "Circles fitted to two others.");
    bind_count("tangents", &PackingCounts::tangents, "Circles placed that touch three others.");
    bind_count("closed", &PackingCounts::closed, "Corners of the front that were filled.");
    bind_count("forced", &PackingCounts::forced, "Rounds in which all edges waited.");
    bind_count("overlapping", &PackingCounts::overlapping,
               "Circles of drawn radius placed although they overlap others.");
    bind_count("halves", &PackingCounts::halves, "2 where a box was packed in halves, else 0.");
}

}  // namespace

void bind_packing(nb::module_& m) {
    m.doc() = "Section 2 of the paper: the front, and circles placed at it.";
    bind_status(m);
    bind_heap(m);
    bind_packing_class(m);
    m.def(
        "deviation_along",
        [](const std::array<double, 3>& quadric, const Place& way, bool is_width) {
            if (!(norm(Point2{way[0], way[1]}) > 0.0)) throw nb::value_error("way is zero");
            return deviation_along({quadric[0], quadric[1], quadric[2]}, {way[0], way[1]},
                                   is_width);
        },
        nb::arg("quadric"), nb::arg("way"), nb::arg("is_width") = false,
        "How far a unit equilateral triangle with an edge along way (x, y) lies from the quadric "
        "4 (xx x^2 + 2 xy x y + yy y^2), at the middles of its edges and at its centre. is_width: "
        "the width of the band that it needs.");
    m.def("pack", &packed, nb::arg("background"), nb::arg("box"), nb::arg("origin"),
          nb::arg("expected"), nb::arg("wanted"), nb::arg("distance"),
          nb::arg("watch") = nb::none(),
          "Pack circles of the background's sizes from the origin (x, y) until the front has left "
          "the box (x0, y0, x1, y1).\n\nexpected: about how many there will be. wanted: how many "
          "at most. distance: from the origin, at most. watch: called now and then with the number "
          "of circles so far; what it raises ends the packing. Read how it ended in ``status``.");
    m.def(
        "pack_box", &packed_box, nb::arg("background"), nb::arg("box"), nb::arg("expected"),
        nb::arg("watch") = nb::none(),
        "The same for all of a box, from its middle; where 50,000 circles or more are expected in "
        "two halves from a line of circles, side by side in the threads that are allowed. "
        "``halves`` is 2 then, and there is no front.");
    m.def("pack_discs", &packed_discs, nb::arg("draw"), nb::arg("box"), nb::arg("origin"),
          nb::arg("expected"), nb::arg("wanted"), nb::arg("distance"),
          nb::arg("watch") = nb::none(),
          "The same for circles of drawn radii: ``draw(n)`` gives the next n of them, (n,).");
}

}  // namespace surfmesh::binding
