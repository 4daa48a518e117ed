// Rows and numbers, which every step over all edges of a model needs.
#include "edges/checked_arguments.hpp"
#include "edges/row_numbers.hpp"

namespace surfmesh::binding {

void bind_rows_of_edges(nb::module_& m);

void bind_rows_of_edges(nb::module_& m) {
    m.def(
        "rows_of",
        [](const Indices& first, const Indices& which) {
            const auto offsets = rows<std::int64_t>(first);
            if (offsets.empty() || !std::is_sorted(offsets.begin(), offsets.end()))
                throw nb::value_error("first has no offsets of its rows");
            require_indices(rows<std::int64_t>(which), offsets.size() - 1, "which");
            return view(rows_of_parts(offsets, rows<std::int64_t>(which)));
        },
        nb::arg("first"), nb::arg("which"),
        "The rows first[k] to first[k + 1] of each k in which (n,), one after the other: (m,) "
        "int64.");
    m.def(
        "node_numbers",
        [](const Indices& first, const Matrix<std::int64_t, 2>& ends, const Indices& known,
           std::int64_t following) {
            const std::size_t nodes = first.shape(0) == 0 ? 0 : rows<std::int64_t>(first).back();
            require_offsets(first, ends.shape(0), nodes, "first");
            for (std::size_t edge = 0; edge < ends.shape(0); ++edge)
                if (first(edge + 1) - first(edge) < 2)
                    throw nb::value_error("an edge has two nodes at least");
            if (known.shape(0) > 0) require_rows(known.shape(0), nodes, "known");
            return view(node_numbers(rows<std::int64_t>(first), rows<SegmentEnds>(ends),
                                     rows<std::int64_t>(known), following));
        },
        nb::arg("first"), nb::arg("ends"), nb::arg("known"), nb::arg("following"),
        "Numbers (n,) int64 of the nodes of edges, of edge k those from first[k] to first[k + 1]: "
        "ends (k, 2) are theirs; nodes with one in known (n,), not -1, keep it, and the others "
        "count on from ``following``. known (0,): there is none.");
}

}  // namespace surfmesh::binding
