#include "sizing/size_bounds.hpp"

#include <algorithm>
#include <limits>

namespace surfmesh {

SizeBounds size_bounds(const StatedBounds& stated, double diagonal) {
    SizeBounds found{};
    if (!stated.max_size && !stated.has_size) found.default_largest = DEFAULT_MAX_SIZE * diagonal;
    double coarsest = std::numeric_limits<double>::infinity();
    for (const auto& top : {stated.max_size, stated.size, found.default_largest})
        if (top) coarsest = std::min(coarsest, *top);
    found.smallest = stated.min_size.value_or(std::min(FINEST_SIZE * diagonal, coarsest));
    found.largest = found.longest = std::max(coarsest, found.smallest);
    if (stated.is_anisotropic && !stated.max_size && !stated.size)
        found.longest = std::max(found.largest, LONGEST_SIZE * diagonal);
    return found;
}

}  // namespace surfmesh
