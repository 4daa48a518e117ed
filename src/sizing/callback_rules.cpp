#include "sizing/callback_rules.hpp"

#include <algorithm>
#include <utility>

#include "binding/arrays.hpp"

namespace surfmesh {
namespace {

namespace nb = nanobind;
using Numbers = nb::ndarray<const double, nb::c_contig, nb::device::cpu>;

/// The numbers that a rule returned, so many.
void copy_checked(nb::handle given, std::span<double> out) {
    Numbers kept;
    if (!nb::try_cast(given, kept) || kept.size() != out.size())
        throw nb::value_error("a rule returned what is not one size for each place");
    std::copy(kept.data(), kept.data() + kept.size(), out.begin());
}

std::pair<Array<double>, Array<double>> both(std::span<const PrincipalCurvatures> k) {
    std::pair<Array<double>, Array<double>> found(k.size(), k.size());
    for (std::size_t i = 0; i < k.size(); ++i) {
        found.first[i] = k[i].k1;
        found.second[i] = k[i].k2;
    }
    return found;
}

}  // namespace

Called::~Called() {
    const nb::gil_scoped_acquire held;
    object_.reset();
    failure_ = nullptr;
}

std::exception_ptr Called::take_failure() const {
    const nb::gil_scoped_acquire held;
    return std::exchange(failure_, nullptr);
}

bool CallbackCurvatureRule::sizes(std::span<const PrincipalCurvatures> k,
                                  std::span<double> out) const {
    return rule_.ask([&] {
        const auto [k1, k2] = both(k);
        copy_checked(rule_.object().attr("sizes")(binding::view(k1), binding::view(k2)), out);
    });
}

bool CallbackCurvatureRule::principal_sizes(std::span<const PrincipalCurvatures> k,
                                            std::span<const double> ratio,
                                            std::span<PrincipalSizes> out) const {
    static_assert(sizeof(PrincipalSizes) == 2 * sizeof(double));
    return rule_.ask([&] {
        const auto [k1, k2] = both(k);
        const nb::object bound = ratio.size() == 1 ? nb::object(nb::float_(ratio[0]))
                                                   : nb::cast(binding::view(Array<double>(ratio)));
        const nb::object given =
            rule_.object().attr("principal_sizes")(binding::view(k1), binding::view(k2), bound);
        copy_checked(given, {reinterpret_cast<double*>(out.data()), 2 * out.size()});
    });
}

bool CallbackPlaceRule::sizes(std::span<const Point3> points, std::span<double> out) const {
    return rule_.ask([&] {
        copy_checked(rule_.object().attr("sizes")(binding::view(Array<Point3>(points))), out);
    });
}

}  // namespace surfmesh
