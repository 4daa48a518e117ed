#include "faces/graded_face.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <utility>

#include "fields/field_plan.hpp"
#include "sizing/principal_lattice.hpp"
#include "sizing/surface_law.hpp"
#include "surfaces/box_diagonal.hpp"
#include "surfaces/chart_making.hpp"
#include "surfaces/coincident_sides.hpp"

namespace surfmesh {
namespace {

constexpr int EXTENT_STEPS = 16;  // of the grid that shows how large a surface is

constexpr double FREE_CELLS = 200'000;   // so many are allowed before they are held to triangles
constexpr double LARGEST_IN_BOX = 16.0;  // times the box's longer side: of degenerate points

/// In what is sampled as finely as its pieces ask for.
class NothingHides final : public HiddenFeatures {
  public:
    bool find(const SeenCells& /*cells*/, bool /*deep*/, std::span<std::uint8_t> found) override {
        std::fill(found.begin(), found.end(), 0);
        return true;
    }
};

bool are_usable(const FaceBoundary& b) {
    for (const Point2 uv : b.uv)
        if (!std::isfinite(uv.x) || !std::isfinite(uv.y)) return false;
    for (const double size : b.sizes)
        if (!(size > 0.0)) return false;
    return !b.uv.empty();
}

/// Of the surface over its box, by a grid of points.
double diagonal_of(SurfaceReader& surface) {
    const auto [low, high] = surface.domain();
    const Point2 wide = high - low;
    Array<Point2> uv;
    for (int row = 0; row <= EXTENT_STEPS; ++row)
        for (int column = 0; column <= EXTENT_STEPS; ++column)
            uv.push_back({low.x + static_cast<double>(column) / EXTENT_STEPS * wide.x,
                          low.y + static_cast<double>(row) / EXTENT_STEPS * wide.y});
    surface.read(uv, 0);
    return box_diagonal(surface[0]);
}

Chart chart_over(SurfaceReader& surface, const KnownSurface& known) {
    const std::size_t samples = chart_samples(static_cast<std::size_t>(known.pieces));
    return chart_of(surface, {KnownAxis{known.is_steady[0], {}, samples},
                              KnownAxis{known.is_steady[1], {}, samples}});
}

/// Does a node stand on two coedges that do not follow each other, as on a seam?
bool has_repeated_nodes(const FaceBoundary& b) {
    Array<std::int64_t> numbers = b.numbers;
    std::sort(numbers.begin(), numbers.end());
    const auto distinct = std::unique(numbers.begin(), numbers.end()) - numbers.begin();
    return static_cast<std::ptrdiff_t>(b.numbers.size()) > distinct + b.pieces();
}

FieldPlan plan_of(const GradedFace& face, const Chart& chart, const CoincidentSides& sides) {
    const FaceBoundary& b = *face.boundary;
    const Point2 extent = chart.extent();
    const int cells = root_cells_of_face(face.surface.pieces);
    const RootGrid grid = root_grid(extent, cells);
    const Array<Point2> places = chart.to_plane(b.uv);
    return {grid,
            extent,
            {extent.x / grid.nx, extent.y / grid.ny},
            face.slope,
            LARGEST_IN_BOX * std::max(extent.x, extent.y),
            sides.partner,
            sides.reversed,
            small_sources(places, b.sizes, grid, extent),
            true,
            false,
            FREE_CELLS,
            std::numeric_limits<double>::infinity(),
            false,
            false,
            1.0};
}

/// What the core found out about sizes on a face.
struct GradedField {
    Chart chart;
    Background background;
    bool on_lattice;
};

/// Nothing where sizes cannot be graded, a side is a point, or the surface could not tell.
std::optional<GradedField> graded_field(const GradedFace& face) {
    const FaceBoundary& b = *face.boundary;
    const AskedRules& asked = *face.asked;
    const Surface& surface = *face.surface.over_box;
    SurfaceReader reader(surface);
    const double diagonal = diagonal_of(reader);
    SizeRules rules = rules_on(asked, diagonal);
    Chart chart = chart_over(reader, face.surface);
    if (reader.failed() || !(diagonal > 0.0)) return {};
    bool on_lattice = false;
    if (may_form_lattice(asked)) {
        SizeRules of_lattice = rules_on(asked, diagonal, true);
        on_lattice = keeps_lattice(reader, chart.extent(), of_lattice, face.slope);
        if (on_lattice) rules = std::move(of_lattice);
    }
    CoincidentSides sides;
    if (has_repeated_nodes(b)) sides = coincident_sides(reader, {});
    if (reader.failed() || sides.has_point()) return {};
    const auto limits = std::make_shared<const SizeLimits>(b.points, b.sizes, face.slope,
                                                           std::span<const MetricRoot3>{});
    FieldBuilder builder(plan_of(face, chart, sides));
    SurfaceLaw law(surface, chart, std::move(rules), std::nullopt, {limits, 0.0, false});
    NothingHides hidden;
    if (builder.refine(law, hidden).status != FieldStatus::done) return {};
    return GradedField{std::move(chart), builder.background(), on_lattice};
}

FaceMesh not_begun(FaceEnd end) {
    FaceMesh made;
    made.end = end;
    return made;
}

}  // namespace

FaceMesh mesh_graded(const GradedFace& face, const PatchHooks& hooks) {
    if (!are_usable(*face.boundary)) return not_begun(FaceEnd::unprepared);
    if (may_have_tubes(*face.surface.of_face, *face.boundary)) return not_begun(FaceEnd::tubes);
    const std::optional<GradedField> field = graded_field(face);
    if (!field) return not_begun(FaceEnd::unprepared);
    FaceManner manner = face.manner;
    manner.on_lattice = field->on_lattice;
    return mesh_face({*face.surface.over_box, field->chart, field->background},
                     polygons_of(*face.boundary), manner, hooks);
}

}  // namespace surfmesh
