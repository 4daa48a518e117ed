// Features of a surface that lie between the samples of a cell, where its derivatives are bounded.
//
// Where the surface can bound them over a cell (formulas can, by interval arithmetic), a cell may
// hide something while the bound admits a curvature that would at least halve the size. Nothing
// hides in a cell that is narrow beside the sizes seen and that the bound shows to be flat.
#pragma once

#include <atomic>
#include <optional>
#include <span>

#include "fields/field_builder.hpp"
#include "sizing/size_rules.hpp"
#include "surfaces/chart.hpp"
#include "surfaces/surface.hpp"

namespace surfmesh {

class BoundedFeatures final : public HiddenFeatures {
  public:
    /// angle (degrees), chord: what is asked for. With an angle surfaces curved both ways alike ask
    /// for the smallest sizes, else those curved one way only. What rises less than a fraction of
    /// the chord within a deep cell is no feature.
    BoundedFeatures(const Surface& surface, const Chart& chart, const SizeRules& rules,
                    std::optional<double> angle, std::optional<double> chord)
        : surface_(surface), chart_(chart), rules_(rules), angle_(angle), chord_(chord) {}

    [[nodiscard]] bool find(const SeenCells& cells, bool deep,
                            std::span<std::uint8_t> found) override;
    [[nodiscard]] std::exception_ptr take_failure() override;

  private:
    void bound_curvature(const SeenCells& cells, std::size_t first, std::span<double> k);
    void keep_rising(const SeenCells& cells, std::span<const std::int32_t> some,
                     std::span<std::uint8_t> found);
    [[nodiscard]] bool is_flat(const SeenCells& cells, std::size_t cell, double k) const;
    [[nodiscard]] bool beside_infinite_speed(Point2 low, Point2 high) const;

    const Surface& surface_;
    const Chart& chart_;
    const SizeRules& rules_;
    std::optional<double> angle_, chord_;
    std::atomic<SurfaceStatus> status_ = SurfaceStatus::DONE;
};

}  // namespace surfmesh
