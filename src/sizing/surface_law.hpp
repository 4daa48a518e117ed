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
#include "surfaces/surface.hpp"

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

class SurfaceLaw final : public NodeLaw {
  public:
    SurfaceLaw(const Surface& surface, Chart chart, SizeRules rules, std::optional<Rims> rims,
               OuterLimits outer);

    [[nodiscard]] bool ask(std::span<const Point2> xy, FieldNodes& nodes) override;
    [[nodiscard]] std::exception_ptr take_failure() override;

    [[nodiscard]] const Surface& surface() const { return surface_; }
    [[nodiscard]] const Chart& chart() const { return chart_; }
    [[nodiscard]] const SizeRules& rules() const { return rules_; }

  private:
    /// What rules are asked with.
    struct Places {
        Array<PrincipalCurvatures> curvature;
        Array<std::uint8_t> degenerate;
    };

    void read(std::span<const Point2> xy, std::size_t first, FieldNodes& nodes, Places& places);
    void lower_at_rims(std::span<const Point2> xy, std::size_t first, FieldNodes& nodes);
    [[nodiscard]] bool lower_by_rules(const Places& places, FieldNodes& nodes) const;
    void bound(std::size_t first, std::size_t last, FieldNodes& nodes) const;

    const Surface& surface_;
    Chart chart_;
    SizeRules rules_;
    std::optional<Rims> rims_;
    OuterLimits outer_;
    std::atomic<SurfaceStatus> status_ = SurfaceStatus::DONE;
};

}  // namespace surfmesh
