// The same law where sizes depend on the direction: two at each place, along principal directions.
//
// In: places in the scaled plane. Out: nodes of a size field with `size` and `longer`, as the rules
// have them along the principal directions, lowered to what holds along rims and loops and to outer
// limits in their own directions; with the rates at which directions turn. `limit_longer_sizes`
// uses these once the field is refined: how wide triangles become is known then.
#pragma once

#include "sizing/direction_rates.hpp"
#include "sizing/surface_law.hpp"
#include "sizing/two_sizes.hpp"

namespace surfmesh {

class StretchedLaw final : public SurfaceLaw {
  public:
    /// even: the curvatures are known to be the same everywhere.
    StretchedLaw(const Surface& surface, Chart chart, SizeRules rules, std::optional<Rims> rims,
                 OuterLimits outer, bool even)
        : SurfaceLaw(surface, std::move(chart), std::move(rules), std::move(rims),
                     std::move(outer)),
          even_(even) {}

    [[nodiscard]] bool ask(std::span<const Point2> xy, FieldNodes& nodes) override;

    /// Sizes across `along` where no more than a ratio of the two is made use of.
    ///
    /// What a long edge takes of the chord where both curvatures are alike is free again. Says
    /// whether the rules could tell.
    [[nodiscard]] bool regained(const FieldNodes& nodes, std::span<const double> ratio,
                                std::span<double> size) const;

  private:
    struct Places {
        Array<Point2> uv;
        Array<PrincipalDirections> principal;
        Array<PrincipalCurvatures> curvature;
        Array<std::uint8_t> degenerate, along_first;
    };

    struct PlaceTangents {
        Point3 ru, rv;
    };

    void read(std::span<const Point2> xy, std::size_t first, FieldNodes& nodes, Places& places,
              std::span<PlaceTangents> tangents);
    [[nodiscard]] bool ask_rules(const FieldNodes& nodes, std::span<const PlaceTangents> tangents,
                                 Places& places, std::span<TwoSizes> found) const;
    void lower_at_rims(std::span<const Point2> xy, std::size_t first, const FieldNodes& nodes,
                       std::span<TwoSizes> found);
    void fill(std::size_t first, const Places& places, std::span<const TwoSizes> found,
              FieldNodes& nodes);
    void find_turn_rates(std::size_t first, std::size_t count, const Places& places,
                         FieldNodes& nodes);

    bool even_;
};

/// Largest `longer` of a node where principal directions change, of triangles that are `size` wide.
[[nodiscard]] double longest_at(const FieldNodes& nodes, std::ptrdiff_t node, double size,
                                double chord);

/// Lower long sizes of a refined field where directions change, raise short ones where long ones
/// are not reached.
///
/// The width of a triangle is then known: it is at most what growth allows in any metric.
/// FieldStatus::failed: see NodeLaw.
[[nodiscard]] FieldOutcome limit_longer_sizes(FieldBuilder& builder, const StretchedLaw& law,
                                              double chord);

}  // namespace surfmesh
