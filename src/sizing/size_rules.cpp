#include "sizing/size_rules.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "sizing/size_bounds.hpp"

namespace surfmesh {
namespace {

constexpr double NO_RULE = std::numeric_limits<double>::infinity();

double ratio_of(std::span<const double> ratio, std::size_t i) {
    return ratio.size() == 1 ? ratio[0] : ratio[i];
}

}  // namespace

double ChordRule::factor(PrincipalCurvatures k, double ratio) const {
    return is_width_ ? std::sqrt(share_of_width(k, ratio)) : 1.0;
}

double ChordRule::size(PrincipalCurvatures k) const {
    return on_lattice_ ? lattice_chord_size(k, chord_) : chord_size(k, chord_);
}

bool ChordRule::sizes(std::span<const PrincipalCurvatures> k, std::span<double> out) const {
    for (std::size_t i = 0; i < k.size(); ++i) out[i] = factor(k[i], 1.0) * size(k[i]);
    return true;
}

bool ChordRule::principal_sizes(std::span<const PrincipalCurvatures> k,
                                std::span<const double> ratio,
                                std::span<PrincipalSizes> out) const {
    for (std::size_t i = 0; i < k.size(); ++i) {
        const auto sizes_of = !evened_      ? principal_chord_sizes
                              : on_lattice_ ? saddle_lattice_sizes
                                            : evened_chord_sizes;
        const auto [first, second] = sizes_of(k[i], chord_, ratio_of(ratio, i));
        const double part = factor(k[i], ratio_of(ratio, i));
        out[i] = {part * first, part * second};
    }
    return true;
}

bool QuadraticChordRule::sizes(std::span<const PrincipalCurvatures> k,
                               std::span<double> out) const {
    for (std::size_t i = 0; i < k.size(); ++i) out[i] = quadratic_chord_size(k[i], chord_);
    return true;
}

bool QuadraticChordRule::principal_sizes(std::span<const PrincipalCurvatures> k,
                                         std::span<const double> /*ratio*/,
                                         std::span<PrincipalSizes> out) const {
    for (std::size_t i = 0; i < k.size(); ++i) {
        const double size = quadratic_chord_size(k[i], chord_);
        out[i] = {size, size};
    }
    return true;
}

bool AngleRule::sizes(std::span<const PrincipalCurvatures> k, std::span<double> out) const {
    for (std::size_t i = 0; i < k.size(); ++i) out[i] = most(angle_size(k[i], angle_), finest_);
    return true;
}

bool AngleRule::principal_sizes(std::span<const PrincipalCurvatures> k,
                                std::span<const double> ratio,
                                std::span<PrincipalSizes> out) const {
    for (std::size_t i = 0; i < k.size(); ++i) {
        const auto [first, second] = principal_angle_sizes(k[i], angle_, ratio_of(ratio, i));
        out[i] = {most(first, finest_), most(second, finest_)};
    }
    return true;
}

std::shared_ptr<const CurvatureRule> AngleRule::on_extent(double diagonal) const {
    return std::make_shared<AngleRule>(angle_, FINEST_BY_ANGLE * diagonal);
}

bool NormalDeviationRule::sizes(std::span<const PrincipalCurvatures> k,
                                std::span<double> out) const {
    for (std::size_t i = 0; i < k.size(); ++i)
        out[i] = most(normal_deviation_size(k[i], angle_), finest_);
    return true;
}

bool NormalDeviationRule::principal_sizes(std::span<const PrincipalCurvatures> k,
                                          std::span<const double> /*ratio*/,
                                          std::span<PrincipalSizes> out) const {
    for (std::size_t i = 0; i < k.size(); ++i)
        out[i] = {most(normal_deviation_size({k[i].k1, k[i].k1}, angle_), finest_),
                  most(normal_deviation_size({k[i].k2, k[i].k2}, angle_), finest_)};
    return true;
}

bool ConstantSize::sizes(std::span<const Point3> points, std::span<double> out) const {
    std::fill_n(out.begin(), points.size(), size_);
    return true;
}

bool SizeRules::from_curvature(std::span<const PrincipalCurvatures> k,
                               std::span<double> out) const {
    Array<double> own(k.size());
    std::fill(out.begin(), out.end(), NO_RULE);
    for (const auto& rule : by_curvature) {
        if (!rule->sizes(k, own)) return false;
        for (std::size_t i = 0; i < k.size(); ++i) out[i] = least(out[i], own[i]);
    }
    for (double& size : out) size = within(size);
    return true;
}

bool SizeRules::shorter(std::span<const PrincipalCurvatures> k, std::span<double> out) const {
    if (!is_anisotropic()) return from_curvature(k, out);
    Array<PrincipalSizes> both(k.size());
    if (!principal(k, {&anisotropy, 1}, both)) return false;
    for (std::size_t i = 0; i < k.size(); ++i) out[i] = least(both[i].first, both[i].second);
    return true;
}

bool SizeRules::principal(std::span<const PrincipalCurvatures> k, std::span<const double> ratio,
                          std::span<PrincipalSizes> out) const {
    Array<PrincipalSizes> own(k.size());
    std::fill(out.begin(), out.end(), PrincipalSizes{NO_RULE, NO_RULE});
    for (const auto& rule : by_curvature) {
        if (!rule->principal_sizes(k, ratio, own)) return false;
        for (std::size_t i = 0; i < k.size(); ++i)
            out[i] = {least(out[i].first, own[i].first), least(out[i].second, own[i].second)};
    }
    for (std::size_t i = 0; i < k.size(); ++i) {
        const double wanted = least(out[i].first, out[i].second);
        const double shorter = within(wanted);
        // where it is flat both ways no direction is known: the ratio falls to one
        const double fraction = shorter / wanted;
        const double flat = std::isnan(fraction) ? 0.0 : least(fraction, 1.0);
        double most_long = least(shorter * most(ratio_of(ratio, i) * (flat * flat), 1.0), longest);
        most_long = most(most_long, shorter);
        out[i] = {least(most(out[i].first, shorter), most_long),
                  least(most(out[i].second, shorter), most_long)};
    }
    return true;
}

bool SizeRules::from_place(std::span<const Point3> points, std::span<double> out) const {
    Array<double> own(points.size());
    std::fill(out.begin(), out.end(), NO_RULE);
    for (const auto& rule : by_place) {
        if (!rule->sizes(points, own)) return false;
        for (std::size_t i = 0; i < points.size(); ++i) out[i] = least(out[i], own[i]);
    }
    return true;
}

std::exception_ptr SizeRules::take_failure() const {
    for (const auto& rule : by_curvature)
        if (const std::exception_ptr failure = rule->take_failure()) return failure;
    for (const auto& rule : by_place)
        if (const std::exception_ptr failure = rule->take_failure()) return failure;
    return {};
}

}  // namespace surfmesh
