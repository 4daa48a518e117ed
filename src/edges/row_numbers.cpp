#include "edges/row_numbers.hpp"

namespace surfmesh {

Array<std::int64_t> rows_of_parts(std::span<const std::int64_t> first,
                                  std::span<const std::int64_t> which) {
    std::int64_t count = 0;
    for (const std::int64_t k : which) count += first[k + 1] - first[k];
    auto found = Array<std::int64_t>::unfilled(static_cast<std::size_t>(count));
    std::int64_t* row = found.begin();
    for (const std::int64_t k : which)
        for (std::int64_t i = first[k]; i < first[k + 1]; ++i) *row++ = i;
    return found;
}

Array<std::int64_t> node_numbers(std::span<const std::int64_t> first,
                                 std::span<const SegmentEnds> ends,
                                 std::span<const std::int64_t> known, std::int64_t following) {
    auto found = Array<std::int64_t>::unfilled(static_cast<std::size_t>(first.back()));
    for (std::size_t edge = 0; edge < ends.size(); ++edge) {
        const std::int64_t last = first[edge + 1] - 1;
        found[first[edge]] = ends[edge].start;
        for (std::int64_t i = first[edge] + 1; i < last; ++i)
            found[i] = known.empty() || known[i] < 0 ? following++ : known[i];
        found[last] = ends[edge].end;
    }
    return found;
}

}  // namespace surfmesh
