// The ungraded target sizes at points of one surface, from its curvature and what is asked for.
//
// In: places in the scaled plane of the surface's chart. Out: nodes of a size field. Each is the
// least that any rule, rim or loop allows there, within the bounds, and within limits of edges or
// of earlier rounds. Places are asked for in blocks that several threads may share; nothing of one
// place depends on another.
#pragma once

#include <array>
#include <atomic>
#include <memory>
#include <optional>
#include <span>

#include "fields/field_builder.hpp"
#include "sizing/rim_sizes.hpp"
#include "sizing/size_limits.hpp"
#include "sizing/size_rules.hpp"
#include "surfaces/chart.hpp"
#include "surfaces/fundamental_forms.hpp"
#include "surfaces/surface.hpp"
#include "surfaces/surface_reader.hpp"

namespace surfmesh {

/// Where a surface of formulas ends, and ``chord`` holds along it.
struct Rims {
    double chord;
    std::array<bool, 4> open_sides;           // of the rectangle, numbered as Python's ``sides``
    std::shared_ptr<const SizeLimits> loops;  // near trimming loops, or none
};

/// Limits of edges or of earlier rounds.
struct OuterLimits {
    std::shared_ptr<const SizeLimits> limits;  // or none
    double least;                              // none goes below it
    bool are_targets;                          // sizes within them count as asked for
};

/// I^(1/2) in the scaled plane, at a point of it.
[[nodiscard]] SizeTensor root_of_form(const FundamentalForms& forms, const ChartPoint& at);

class SurfaceLaw : public NodeLaw {
  public:
    SurfaceLaw(const Surface& surface, Chart chart, SizeRules rules, std::optional<Rims> rims,
               OuterLimits outer);

    [[nodiscard]] bool ask(std::span<const Point2> xy, FieldNodes& nodes) override;
    [[nodiscard]] std::exception_ptr take_failure() override;

    [[nodiscard]] const Surface& surface() const { return surface_; }
    [[nodiscard]] const Chart& chart() const { return chart_; }
    [[nodiscard]] const SizeRules& rules() const { return rules_; }

  protected:
    /// Call work(place, size) for those of some places that lie on a side of the rectangle.
    template <class Work>
    void at_side(std::size_t side, std::span<const Point2> xy, const Work& work) {
        Array<Point2> uv;
        Array<std::size_t> rows;
        for (std::size_t i = 0; i < xy.size(); ++i) {
            if (!is_on_side(xy[i], side)) continue;
            rows.push_back(i);
            uv.push_back(chart_.to_uv(xy[i]));
        }
        if (rows.empty()) return;
        SurfaceReader reader(surface_);
        reader.read({uv.data(), uv.size()}, 2);
        if (reader.failed()) {
            status_.store(reader.status());
            return;
        }
        const Point2 step = side % 2 == 0 ? Point2{1.0, 0.0} : Point2{0.0, 1.0};
        for (std::size_t k = 0; k < rows.size(); ++k)
            work(rows[k], rim_size(reader, k, step, rims_->chord));
    }

    const Surface& surface_;
    Chart chart_;
    SizeRules rules_;
    std::optional<Rims> rims_;
    OuterLimits outer_;
    std::atomic<SurfaceStatus> status_ = SurfaceStatus::DONE;

  private:
    [[nodiscard]] bool is_on_side(Point2 xy, std::size_t side) const;
    /// What rules are asked with.
    struct Places {
        Array<PrincipalCurvatures> curvature;
        Array<std::uint8_t> degenerate;
    };

    void read(std::span<const Point2> xy, std::size_t first, FieldNodes& nodes, Places& places);
    void lower_at_rims(std::span<const Point2> xy, std::size_t first, FieldNodes& nodes);
    [[nodiscard]] bool lower_by_rules(const Places& places, FieldNodes& nodes) const;
    void bound(std::size_t first, std::size_t last, FieldNodes& nodes) const;
};

}  // namespace surfmesh
