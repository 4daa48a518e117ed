#include "patch/folds.hpp"

#include <limits>

#include "surfaces/fundamental_forms.hpp"

namespace surfmesh {

Array<double> cosines_with_surface(SurfaceReader& surface, std::span<const SpaceTriangle> corners,
                                   std::span<const Point2> uv) {
    surface.read(uv, 1);
    Array<double> cosine(corners.size(), std::numeric_limits<double>::quiet_NaN());
    for (std::size_t i = 0; i < corners.size(); ++i) {
        const Point3 n = cross(corners[i][1] - corners[i][0], corners[i][2] - corners[i][0]);
        const Point3 m = cross(surface[1][i], surface[2][i]);
        const double lengths = norm(n) * norm(m);
        if (lengths > 0.0) cosine[i] = lane_dot(n, m) / lengths;
    }
    return cosine;
}

}  // namespace surfmesh
