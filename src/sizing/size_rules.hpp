// What each rule asks for at points of a surface, and the bounds that their least is kept within.
//
//     ChordRule, AngleRule, ...  -> sizes by curvature --.
//     ConstantSize, ...          -> sizes by place ------+-- least -> within the bounds
//
// Rules know their numbers alone; who asked for them, and in what words, is known in Python
// (surfmesh.sizing.rules), where the same formulas are called. A rule that only Python knows is
// asked for a block at a time (callback_rules.hpp). Its failure is kept: see NodeLaw.
#pragma once

#include <exception>
#include <memory>
#include <span>
#include <vector>

#include "sizing/curvature_sizes.hpp"
#include "values/array.hpp"

namespace surfmesh {

/// Sizes that follow from the curvature; infinite where it allows any.
class CurvatureRule {
  public:
    virtual ~CurvatureRule() = default;
    /// In every direction. Says whether the rule could tell.
    [[nodiscard]] virtual bool sizes(std::span<const PrincipalCurvatures> k,
                                     std::span<double> out) const = 0;
    /// Along the directions of k1 and k2, for ratios of the two, one for each or one for all.
    [[nodiscard]] virtual bool principal_sizes(std::span<const PrincipalCurvatures> k,
                                               std::span<const double> ratio,
                                               std::span<PrincipalSizes> out) const = 0;
    /// The rule on a surface of this diagonal; nothing where that makes no difference.
    [[nodiscard]] virtual std::shared_ptr<const CurvatureRule> on_extent(
        double /*diagonal*/) const {
        return {};
    }
    [[nodiscard]] virtual std::exception_ptr take_failure() const { return {}; }
};

/// Sizes that depend on the place alone, and hold in every direction.
class PlaceRule {
  public:
    virtual ~PlaceRule() = default;
    /// Infinite where nothing is asked for. Says whether the rule could tell.
    [[nodiscard]] virtual bool sizes(std::span<const Point3> points,
                                     std::span<double> out) const = 0;
    [[nodiscard]] virtual std::exception_ptr take_failure() const { return {}; }
};

/// ``chord``, model units. is_width: of the whole band that a triangle needs, where it may move to
/// lie in the middle of it. on_lattice: of isotropic triangles whose edges lie where they deviate
/// least. evened: of stretched triangles whose corners move to where they may stay large.
class ChordRule final : public CurvatureRule {
  public:
    explicit ChordRule(double chord, bool is_width = false, bool on_lattice = false,
                       bool evened = false)
        : chord_(chord), is_width_(is_width), on_lattice_(on_lattice), evened_(evened) {}
    bool sizes(std::span<const PrincipalCurvatures> k, std::span<double> out) const override;
    bool principal_sizes(std::span<const PrincipalCurvatures> k, std::span<const double> ratio,
                         std::span<PrincipalSizes> out) const override;

  private:
    /// On the sizes: they go with the root of the chord.
    [[nodiscard]] double factor(PrincipalCurvatures k, double ratio) const;
    [[nodiscard]] double size(PrincipalCurvatures k) const;
    double chord_;
    bool is_width_, on_lattice_, evened_;
};

/// ``chord`` of quadratic triangles, model units: the same in all directions.
class QuadraticChordRule final : public CurvatureRule {
  public:
    explicit QuadraticChordRule(double chord) : chord_(chord) {}
    bool sizes(std::span<const PrincipalCurvatures> k, std::span<double> out) const override;
    bool principal_sizes(std::span<const PrincipalCurvatures> k, std::span<const double> ratio,
                         std::span<PrincipalSizes> out) const override;

  private:
    double chord_;
};

/// ``angle``, degrees; nothing below ``finest``, model units, is asked for.
class AngleRule final : public CurvatureRule {
  public:
    AngleRule(double angle, double finest) : angle_(angle), finest_(finest) {}
    bool sizes(std::span<const PrincipalCurvatures> k, std::span<double> out) const override;
    bool principal_sizes(std::span<const PrincipalCurvatures> k, std::span<const double> ratio,
                         std::span<PrincipalSizes> out) const override;
    std::shared_ptr<const CurvatureRule> on_extent(double diagonal) const override;

  private:
    double angle_, finest_;
};

/// The normals of neighbours differ by at most ``angle``, likewise.
class NormalDeviationRule final : public CurvatureRule {
  public:
    NormalDeviationRule(double angle, double finest) : angle_(angle), finest_(finest) {}
    bool sizes(std::span<const PrincipalCurvatures> k, std::span<double> out) const override;
    bool principal_sizes(std::span<const PrincipalCurvatures> k, std::span<const double> ratio,
                         std::span<PrincipalSizes> out) const override;

  private:
    double angle_, finest_;
};

/// The same size everywhere.
class ConstantSize final : public PlaceRule {
  public:
    explicit ConstantSize(double size) : size_(size) {}
    bool sizes(std::span<const Point3> points, std::span<double> out) const override;

  private:
    double size_;
};

/// All rules that hold on one surface.
struct SizeRules {
    std::vector<std::shared_ptr<const CurvatureRule>> by_curvature;
    std::vector<std::shared_ptr<const PlaceRule>> by_place;
    double smallest, largest;  // of what is asked for
    double longest;            // along the longer axis of an anisotropic metric
    double anisotropy;         // largest ratio of two sizes; 1: they do not depend on the direction

    [[nodiscard]] bool is_anisotropic() const { return anisotropy > 1.0; }
    [[nodiscard]] double within(double size) const { return least(most(size, smallest), largest); }
    /// Size by the curvature alone, within the bounds.
    [[nodiscard]] bool from_curvature(std::span<const PrincipalCurvatures> k,
                                      std::span<double> out) const;
    /// Size in the direction that the curvature allows least in, within the bounds.
    [[nodiscard]] bool shorter(std::span<const PrincipalCurvatures> k, std::span<double> out) const;
    /// Sizes along the directions of k1 and k2 by curvature, within the bounds.
    [[nodiscard]] bool principal(std::span<const PrincipalCurvatures> k,
                                 std::span<const double> ratio,
                                 std::span<PrincipalSizes> out) const;
    /// Size by the place alone, not within the bounds; infinite for none.
    [[nodiscard]] bool from_place(std::span<const Point3> points, std::span<double> out) const;
    /// What a rule that could not tell has raised, once.
    [[nodiscard]] std::exception_ptr take_failure() const;
};

}  // namespace surfmesh
