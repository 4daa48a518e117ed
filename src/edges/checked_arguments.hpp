// Arrays over the edges of a model, as bindings of this room take and check them.
#pragma once

#include <algorithm>
#include <cstdint>
#include <memory>
#include <string>

#include "binding/arrays.hpp"
#include "edges/edge_courses.hpp"

namespace surfmesh::binding {

using Numbers = Vector<double>;
using Indices = Vector<std::int64_t>;
using Flags = Vector<std::uint8_t>;

inline void require_offsets(const Indices& offsets, std::size_t count, std::size_t last,
                            const char* what) {
    const auto values = rows<std::int64_t>(offsets);
    if (values.size() != count + 1 || values.front() != 0 ||
        values.back() != static_cast<std::int64_t>(last) ||
        !std::is_sorted(values.begin(), values.end()))
        throw nb::value_error((std::string(what) + " has no offsets of its rows").c_str());
}

inline SharedSurfaces surfaces_of(const nb::list& given, std::size_t count) {
    require_rows(given.size(), count, "surfaces");
    SharedSurfaces surfaces;
    surfaces.reserve(given.size());
    for (const nb::handle surface : given)
        surfaces.push_back(nb::cast<std::shared_ptr<Surface>>(surface));
    return surfaces;
}

}  // namespace surfmesh::binding
