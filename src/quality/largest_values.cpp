#include "quality/largest_values.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <numeric>

namespace surfmesh {
namespace {

/// The first few of many things in an order: of these it keeps twice as many, at most, and passes
/// over what cannot be among them.
template <class T, class Order>
class Foremost {
  public:
    Foremost(std::size_t count, Order order) : count_(count), order_(order) {
        kept_.reserve(2 * count);
    }

    void add(const T& value) {
        if (is_bounded_ && !order_(value, last_)) return;
        kept_.push_back(value);
        if (kept_.size() == 2 * count_) drop_others();
    }
    /// In no order but that the last one comes last, where there are as many.
    Array<T>& found() {
        if (kept_.size() >= count_) drop_others();
        return kept_;
    }

  private:
    void drop_others() {
        std::nth_element(kept_.begin(), kept_.begin() + (count_ - 1), kept_.end(), order_);
        kept_.resize(count_);
        last_ = kept_.back();
        is_bounded_ = true;
    }

    std::size_t count_;
    Order order_;
    Array<T> kept_;
    T last_{};  // of those wanted, so far
    bool is_bounded_ = false;
};

struct Numbered {
    double value;  // infinite for NaN
    std::int32_t number;
};

bool is_larger_or_earlier(const Numbered& a, const Numbered& b) {
    return a.value != b.value ? a.value > b.value : a.number < b.number;
}

bool is_less_or_earlier(const Numbered& a, const Numbered& b) {
    return a.value != b.value ? a.value < b.value : a.number < b.number;
}

/// The value at place ``count`` - 1 of an order, and the one before it, itself if there is none.
struct LastTwo {
    double before, last;
};

template <class Order>
LastTwo last_two(std::span<const double> values, std::size_t count, Order order) {
    Foremost<double, Order> foremost(count, order);
    for (const double value : values) foremost.add(value);
    const Array<double>& found = foremost.found();
    const double last = found[count - 1];
    if (count == 1) return {last, last};
    return {*std::max_element(found.begin(), found.end() - 1, order), last};
}

}  // namespace

Array<std::int32_t> largest_values(std::span<const double> values, std::size_t count) {
    Array<std::int32_t> numbers(std::min(count, values.size()));
    std::iota(numbers.begin(), numbers.end(), 0);
    if (count == 0 || values.size() <= count) return numbers;
    Foremost<Numbered, decltype(&is_larger_or_earlier)> foremost(count, is_larger_or_earlier);
    for (std::size_t i = 0; i < values.size(); ++i) {
        const bool is_nan = std::isnan(values[i]);
        foremost.add({is_nan ? std::numeric_limits<double>::infinity() : values[i],
                      static_cast<std::int32_t>(i)});
    }
    const Array<Numbered>& found = foremost.found();
    for (std::size_t k = 0; k < count; ++k) numbers[k] = found[k].number;
    std::sort(numbers.begin(), numbers.end());
    return numbers;
}

Array<std::int32_t> least_values(std::span<const double> values, std::size_t count) {
    if (count == 0) return {};
    Foremost<Numbered, decltype(&is_less_or_earlier)> foremost(count, is_less_or_earlier);
    for (std::size_t i = 0; i < values.size(); ++i)
        if (!std::isnan(values[i])) foremost.add({values[i], static_cast<std::int32_t>(i)});
    const Array<Numbered>& found = foremost.found();
    std::sort(found.begin(), found.end(), is_less_or_earlier);
    Array<std::int32_t> numbers;
    for (const Numbered& one : found) numbers.push_back(one.number);
    return numbers;
}

double quantile(std::span<const double> values, double fraction) {
    for (const double value : values)
        if (std::isnan(value)) return value;
    const std::size_t count = values.size();
    const double place = fraction * static_cast<double>(count - 1);
    const auto below = static_cast<std::size_t>(place);
    const std::size_t above = std::min(below + 1, count - 1);
    double low, high;
    if (2 * below < count) {
        const LastTwo found = last_two(values, above + 1, std::less<>());
        low = above > below ? found.before : found.last;
        high = found.last;
    } else {
        const LastTwo found = last_two(values, count - below, std::greater<>());
        low = found.last;
        high = above > below ? found.before : found.last;
    }
    const double part = place - static_cast<double>(below);
    return part < 0.5 ? low + (high - low) * part : high - (high - low) * (1.0 - part);
}

}  // namespace surfmesh
