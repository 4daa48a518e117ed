#include <nanobind/stl/shared_ptr.h>
#include <nanobind/stl/tuple.h>

#include <algorithm>

#include "binding/arrays.hpp"
#include "binding/released.hpp"
#include "edges/checked_arguments.hpp"
#include "edges/edge_mates.hpp"
#include "edges/edges_beside.hpp"
#include "edges/gap_sizes.hpp"
#include "edges/mated_cuts.hpp"
#include "edges/narrow_faces.hpp"

namespace surfmesh::binding {

template <>
struct Row<EdgesBeside> : RowOf<std::int64_t, 3> {};

namespace {

/// Refuse edges without samples, which have no curve.
void require_samples(const SampledCurves& edges, std::span<const std::int64_t> which) {
    require_indices(which, edges.first.size() - 1, "edges");
    for (const std::int64_t edge : which)
        if (edges.count(edge) > 0 && !edges.curves.curves[static_cast<std::size_t>(edge)])
            throw nb::value_error("an edge with samples has no curve");
}

SampledCurves checked_samples(const CurvePieces& curves, const Points3& points, const Numbers& t,
                              const Indices& first) {
    require_offsets(first, curves.size(), points.shape(0), "first");
    require_rows(t.shape(0), points.shape(0), "t");
    return {{rows<double>(t), rows<std::int64_t>(first)}, rows<Point3>(points), curves};
}

auto found_narrow_faces(const CurvePieces& curves, const Points3& points, const Numbers& t,
                        const Indices& first, const Indices& first_of_face,
                        const Indices& first_of_loop, const Indices& edge, const Flags& is_reversed,
                        const Numbers& length, const Numbers& area, double diagonal,
                        const Indices& faces, const Numbers& width, const CurvePieces& pcurves,
                        const nb::list& surfaces) {
    const SampledCurves edges = checked_samples(curves, points, t, first);
    require_samples(edges, rows<std::int64_t>(edge));
    require_offsets(first_of_face, area.shape(0), edge.shape(0), "first_of_face");
    require_offsets(first_of_loop, first_of_loop.shape(0) - 1, edge.shape(0), "first_of_loop");
    require_rows(is_reversed.shape(0), edge.shape(0), "is_reversed");
    require_rows(length.shape(0), curves.size(), "length");
    require_indices(rows<std::int64_t>(faces), area.shape(0), "faces");
    require_rows(width.shape(0), faces.shape(0), "width");
    require_rows(pcurves.size(), edge.shape(0), "pcurves");
    const SharedSurfaces shared = surfaces_of(surfaces, faces.shape(0));
    const auto found = released([&] {
        return narrow_faces(edges,
                            {rows<std::int64_t>(first_of_face), rows<std::int64_t>(first_of_loop),
                             rows<std::int64_t>(edge), rows<std::uint8_t>(is_reversed),
                             rows<double>(length), rows<double>(area), diagonal},
                            {rows<std::int64_t>(faces), rows<double>(width), pcurves, shared});
    });
    Array<std::int64_t> runs;
    Array<double> widest;
    for (const NarrowFace& face : found) {
        for (const auto& pair : {face.sides, face.ends})
            for (const auto [start, count] : pair) {
                runs.push_back(start);
                runs.push_back(count);
            }
        runs.push_back(face.is_closed);
        widest.push_back(face.width);
    }
    return std::tuple(view(runs), view(widest));
}

MateRuns found_mate_runs(const CurvePieces& curves, const Points3& points, const Numbers& t,
                         const Indices& first, const Indices& uses, const Flags& is_reversed,
                         const Indices& first_use, const Indices& own, const Indices& other,
                         const Numbers& width, std::size_t fewest) {
    const SampledCurves edges = checked_samples(curves, points, t, first);
    require_samples(edges, rows<std::int64_t>(uses));
    require_rows(is_reversed.shape(0), uses.shape(0), "is_reversed");
    if (first_use.shape(0) == 0) throw nb::value_error("first_use is empty");
    const std::size_t chains = first_use.shape(0) - 1;
    require_offsets(first_use, chains, uses.shape(0), "first_use");
    require_indices(rows<std::int64_t>(own), chains, "own");
    require_indices(rows<std::int64_t>(other), chains, "other");
    require_rows(other.shape(0), own.shape(0), "other");
    require_rows(width.shape(0), own.shape(0), "width");
    std::vector<DirectedEdge> directed;
    for (std::size_t i = 0; i < uses.shape(0); ++i)
        directed.push_back({uses.data()[i], is_reversed.data()[i] != 0});
    const nb::gil_scoped_release released;
    return mate_runs(edges, {directed, rows<std::int64_t>(first_use), rows<std::int64_t>(own),
                             rows<std::int64_t>(other), rows<double>(width), fewest});
}

void make_runs(MateRuns* made, const Indices& edge, const Indices& mate, const Indices& first,
               const Numbers& t, const Numbers& foot, const Numbers& gap) {
    require_rows(mate.shape(0), edge.shape(0), "mate");
    require_offsets(first, edge.shape(0), t.shape(0), "first");
    require_rows(foot.shape(0), t.shape(0), "foot");
    require_rows(gap.shape(0), t.shape(0), "gap");
    for (std::size_t i = 0; i + 1 < first.shape(0); ++i)
        if (first.data()[i] == first.data()[i + 1]) throw nb::value_error("a run has no samples");
    new (made) MateRuns{Array<std::int64_t>(rows<std::int64_t>(edge)),
                        Array<std::int64_t>(rows<std::int64_t>(mate)),
                        Array<std::int64_t>(rows<std::int64_t>(first)),
                        Array<double>(rows<double>(t)),
                        Array<double>(rows<double>(foot)),
                        Array<double>(rows<double>(gap))};
}

/// Refuse runs of edges that have no samples.
void require_edges(const MateRuns& runs, const SampleRows& samples) {
    for (const auto* numbers : {&runs.edge, &runs.mate}) {
        require_indices(std::span<const std::int64_t>(numbers->data(), numbers->size()),
                        samples.first.size() - 1, "runs");
        for (const std::int64_t edge : *numbers)
            if (samples.count(edge) == 0)
                throw nb::value_error("a run is of an edge without samples");
    }
}

auto lowered(const MateRuns& runs, const Numbers& t, const Indices& first, const Numbers& sizes) {
    if (first.shape(0) == 0) throw nb::value_error("first is empty");
    require_offsets(first, first.shape(0) - 1, t.shape(0), "first");
    require_rows(sizes.shape(0), t.shape(0), "sizes");
    const SampleRows samples{rows<double>(t), rows<std::int64_t>(first)};
    require_edges(runs, samples);
    const nb::gil_scoped_release released;
    return lowered_to_mates(samples, runs, rows<double>(sizes));
}

auto cuts(const MateRuns& runs, const CurvePieces& curves, const Points3& points, const Numbers& t,
          const Indices& first, const Matrix<std::int64_t, 2>& ends,
          const Matrix<std::int64_t, 2>& vertices, const Points3& corners, const Numbers& length,
          const Numbers& total_curvature, const Indices& fewest, const Numbers& chord,
          const Numbers& shortest, const Numbers& sizes, double diagonal, double most) {
    const SampledCurves samples = checked_samples(curves, points, t, first);
    require_edges(runs, samples);
    require_samples(samples, runs.edge);
    require_samples(samples, runs.mate);
    require_rows(ends.shape(0), curves.size(), "ends");
    require_rows(vertices.shape(0), curves.size(), "vertices");
    require_indices(std::span(vertices.data(), vertices.size()), corners.shape(0), "vertices");
    for (const Numbers* row : {&length, &total_curvature, &chord, &shortest})
        require_rows(row->shape(0), curves.size(), "a row over edges");
    require_rows(fewest.shape(0), curves.size(), "fewest");
    require_rows(sizes.shape(0), points.shape(0), "sizes");
    const auto found = released([&] {
        return mated_cuts(
            samples, runs,
            {rows<SegmentEnds>(ends), rows<SegmentEnds>(vertices), rows<Point3>(corners),
             rows<double>(length), rows<double>(total_curvature), rows<std::int64_t>(fewest),
             rows<double>(chord), rows<double>(shortest), diagonal, most},
            rows<double>(sizes));
    });
    return std::tuple(view(found.edge), view(found.first), view(found.t));
}

void bind_narrow_faces(nb::module_& m) {
    m.def("narrow_faces", &found_narrow_faces, nb::arg("curves"), nb::arg("points"), nb::arg("t"),
          nb::arg("first"), nb::arg("first_of_face"), nb::arg("first_of_loop"), nb::arg("edge"),
          nb::arg("is_reversed"), nb::arg("length"), nb::arg("area"), nb::arg("diagonal"),
          nb::arg("faces"), nb::arg("width"), nb::arg("pcurves"), nb::arg("surfaces"),
          "Of faces (k,) that may be narrower than width (k,): (9 k,) int64, for each of them the "
          "start and the number of coedges of side 0, side 1, end 0 and end 1, and whether the "
          "sides are loops; and their largest ways across (k,), below 0 of those that are not "
          "narrow.\n\npoints (n, 3), t (n,): samples, of edge e those from first[e] to first[e + "
          "1]. edge, is_reversed (c,): coedges of all faces, loop after loop; pcurves: of these. "
          "length: of the edges. area: of the faces. surfaces: k.");
}

auto found_beside(const Points3& points, const Indices& first, const Matrix<std::int64_t, 2>& ends,
                  const Indices& first_of_face, const Indices& edges, const Indices& coedge_edge,
                  const Indices& coedge_face, const Flags& is_reversed, const Indices& one,
                  const Indices& other, const Numbers& width, double acute) {
    const std::size_t count = ends.shape(0), coedges = coedge_edge.shape(0);
    require_offsets(first, count, points.shape(0), "first");
    require_offsets(first_of_face, width.shape(0), edges.shape(0), "first_of_face");
    require_indices(rows<std::int64_t>(edges), count, "edges");
    require_indices(rows<std::int64_t>(coedge_edge), count, "coedge_edge");
    require_rows(coedge_face.shape(0), coedges, "coedge_face");
    require_indices(rows<std::int64_t>(coedge_face), width.shape(0), "coedge_face");
    require_rows(is_reversed.shape(0), coedges, "is_reversed");
    require_rows(other.shape(0), one.shape(0), "other");
    for (const Indices* row : {&one, &other}) {
        require_indices(rows<std::int64_t>(*row), coedges, "one or other");
        for (const std::int64_t coedge : rows<std::int64_t>(*row)) {
            const std::int64_t* begin = first.data() + coedge_edge.data()[coedge];
            if (begin[1] - begin[0] < 2) throw nb::value_error("an edge that is met has no way");
        }
    }
    Array<EdgesBeside> found;
    {
        const nb::gil_scoped_release released;
        found = edges_beside(
            {rows<Point3>(points),
             {},
             rows<std::int64_t>(first),
             rows<SegmentEnds>(ends),
             rows<std::int64_t>(edges),
             rows<std::int64_t>(first_of_face)},
            {rows<std::int64_t>(coedge_edge), rows<std::int64_t>(coedge_face),
             rows<std::uint8_t>(is_reversed), rows<std::int64_t>(one), rows<std::int64_t>(other)},
            rows<double>(width), acute);
    }
    return view(found);
}

auto sizes_of_gaps(const Points3& points, const Numbers& reach, const Indices& first,
                   const Matrix<std::int64_t, 2>& ends, const Indices& edges,
                   const Indices& first_of_face, const Numbers& asked, const GapLaw& law) {
    require_rows(reach.shape(0), points.shape(0), "reach");
    require_rows(asked.shape(0), points.shape(0), "asked");
    require_offsets(first, ends.shape(0), points.shape(0), "first");
    require_offsets(first_of_face, first_of_face.shape(0) - 1, edges.shape(0), "first_of_face");
    require_indices(rows<std::int64_t>(edges), ends.shape(0), "edges");
    Array<double> found;
    {
        const nb::gil_scoped_release released;
        found = gap_sizes(
            {rows<Point3>(points), rows<double>(reach), rows<std::int64_t>(first),
             rows<SegmentEnds>(ends), rows<std::int64_t>(edges), rows<std::int64_t>(first_of_face)},
            rows<double>(asked), law);
    }
    return view(found);
}

void bind_gap_sizes(nb::module_& m) {
    m.def(
        "gap_sizes",
        [](const Points3& points, const Numbers& reach, const Indices& first,
           const Matrix<std::int64_t, 2>& ends, const Indices& edges, const Indices& first_of_face,
           const Numbers& asked, double along, double least, double ignored, double ignored_of_size,
           double longer, double narrowest, double least_narrow) {
            return sizes_of_gaps(
                points, reach, first, ends, edges, first_of_face, asked,
                {along, least, ignored, ignored_of_size, longer, narrowest, least_narrow});
        },
        nb::arg("points"), nb::arg("reach"), nb::arg("first"), nb::arg("ends"), nb::arg("edges"),
        nb::arg("first_of_face"), nb::arg("asked"), nb::kw_only(), nb::arg("along"),
        nb::arg("least"), nb::arg("ignored"), nb::arg("ignored_of_size"), nb::arg("longer"),
        nb::arg("narrowest"), nb::arg("least_narrow"),
        "Sizes (n,) that the distance of samples from other edges of their faces asks for, "
        "infinite "
        "for none.\n\nThe samples as ``space.edge_gaps`` has them; asked (n,): the sizes there "
        "without gaps. A gap of ``ignored``, or ``ignored_of_size`` of the size there, is the "
        "narrowest that asks: for ``along`` times itself, but at least ``least``, and at least "
        "``longer`` times itself up to ``narrowest``; for that where this would be below "
        "``least_narrow``. Lengths in model units.");
}

void bind_mates(nb::module_& m) {
    nb::class_<MateRuns> runs(m, "MateRuns",
                              "Parts of edges that run beside another edge, sample by sample.");
    runs.def("__init__", &make_runs, nb::arg("edge"), nb::arg("mate"), nb::arg("first"),
             nb::arg("t"), nb::arg("foot"), nb::arg("gap"),
             "edge, mate (k,): numbers. t (n,) rising, foot (n,): fractions of the ranges of both; "
             "gap (n,): distances; of run i from first[i] to first[i + 1].");
    runs.def("__len__", &MateRuns::size);
    bind_read_only_array(runs, "edge", &MateRuns::edge, "(k,) int64");
    bind_read_only_array(runs, "mate", &MateRuns::mate, "(k,) int64");
    bind_read_only_array(runs, "first", &MateRuns::first, "(k + 1,) int64");
    bind_read_only_array(runs, "t", &MateRuns::t, "(n,)");
    bind_read_only_array(runs, "foot", &MateRuns::foot, "(n,)");
    bind_read_only_array(runs, "gap", &MateRuns::gap, "(n,) model units");
    m.def(
        "edges_beside", &found_beside, nb::arg("points"), nb::arg("first"), nb::arg("ends"),
        nb::arg("first_of_face"), nb::arg("edges"), nb::arg("coedge_edge"), nb::arg("coedge_face"),
        nb::arg("is_reversed"), nb::arg("one"), nb::arg("other"), nb::arg("width"),
        nb::arg("acute"),
        "Rows (k, 3) of a face and two of its edges, both ways: edges that follow each other and "
        "turn back, then those that do not meet and are somewhere narrowly apart.\n\npoints (n, "
        "3): samples, of edge e those from first[e] to first[e + 1]; ends (e, 2): vertices. "
        "edges: of face f, each once, from first_of_face[f] to first_of_face[f + 1]. coedge_edge, "
        "coedge_face, is_reversed (c,): of all coedges; other (s,) follow one (s,). width (f,): "
        "of narrow faces; of a face with 0 nothing is looked at. acute: cosine between edges, "
        "above which they turn back.");
    m.def("mate_runs", &found_mate_runs, nb::arg("curves"), nb::arg("points"), nb::arg("t"),
          nb::arg("first"), nb::arg("uses"), nb::arg("is_reversed"), nb::arg("first_use"),
          nb::arg("own"), nb::arg("other"), nb::arg("width"), nb::arg("fewest"),
          "The runs of chains of edges along others.\n\nuses, is_reversed (m,): edges of chain c "
          "from first_use[c] to first_use[c + 1]. own, other (p,): pairs of chains, mates up to "
          "width (p,), in runs of ``fewest`` samples or more.");
    m.def(
        "lowered_to_mates",
        [](const MateRuns& runs, const Numbers& t, const Indices& first, const Numbers& sizes) {
            return view(lowered(runs, t, first, sizes));
        },
        nb::arg("runs"), nb::arg("t"), nb::arg("first"), nb::arg("sizes"),
        "Sizes (n,) at samples, lowered to those of their mates.");
    m.def("mated_cuts", &cuts, nb::arg("runs"), nb::arg("curves"), nb::arg("points"), nb::arg("t"),
          nb::arg("first"), nb::arg("ends"), nb::arg("vertices"), nb::arg("corners"),
          nb::arg("length"), nb::arg("total_curvature"), nb::arg("fewest"), nb::arg("chord"),
          nb::arg("shortest"), nb::arg("sizes"), nb::arg("diagonal"), nb::arg("most"),
          "Nodes of edges with mates that face each other: edges (k,), offsets (k + 1,), fractions "
          "(m,) of their ranges.\n\nends (e, 2): vertices by their numbers in the mesh, vertices "
          "(e, 2): rows of corners (v, 3). fewest (e,): segments, which sag by chord (e,) at most, "
          "infinite for nothing, unless they are no longer than shortest (e,).");
}

}  // namespace

void bind_sides(nb::module_& m) {
    m.attr("ROUND_A_TUBE") = ROUND_A_TUBE;
    bind_narrow_faces(m);
    bind_gap_sizes(m);
    bind_mates(m);
}

}  // namespace surfmesh::binding
