// Rules that are the caller's own objects in Python: the only ones that take the interpreter.
//
// The objects satisfy CurvatureRule and PlaceRule of surfmesh.sizing.rules.rule. They are asked for
// a block at a time; what they return is checked. The first exception is kept until it is taken.
#pragma once

#include <nanobind/nanobind.h>

#include "sizing/size_rules.hpp"

namespace surfmesh {

/// An object of Python and what it has raised; both are touched while the interpreter is held.
class Called {
  public:
    explicit Called(nanobind::object object) : object_(std::move(object)) {}
    ~Called();
    Called(const Called&) = delete;
    Called& operator=(const Called&) = delete;

    [[nodiscard]] const nanobind::object& object() const { return object_; }
    /// Do something with the interpreter held; says whether that raised nothing.
    template <class Work>
    [[nodiscard]] bool ask(const Work& work) const {
        const nanobind::gil_scoped_acquire held;
        try {
            work();
            return true;
        } catch (...) {
            if (!failure_) failure_ = std::current_exception();
            return false;
        }
    }
    [[nodiscard]] std::exception_ptr take_failure() const;

  private:
    nanobind::object object_;
    mutable std::exception_ptr failure_;
};

class CallbackCurvatureRule final : public CurvatureRule {
  public:
    explicit CallbackCurvatureRule(nanobind::object rule) : rule_(std::move(rule)) {}
    bool sizes(std::span<const PrincipalCurvatures> k, std::span<double> out) const override;
    bool principal_sizes(std::span<const PrincipalCurvatures> k, std::span<const double> ratio,
                         std::span<PrincipalSizes> out) const override;
    [[nodiscard]] std::exception_ptr take_failure() const override { return rule_.take_failure(); }

  private:
    Called rule_;
};

class CallbackPlaceRule final : public PlaceRule {
  public:
    explicit CallbackPlaceRule(nanobind::object rule) : rule_(std::move(rule)) {}
    bool sizes(std::span<const Point3> points, std::span<double> out) const override;
    [[nodiscard]] std::exception_ptr take_failure() const override { return rule_.take_failure(); }

  private:
    Called rule_;
};

}  // namespace surfmesh
