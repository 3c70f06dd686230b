#include "scenarios/tuning/tune_file.hpp"

#include <fmt/format.h>

#include <type_traits>

namespace understory {
namespace {

/// The visitor that collects them.
class NumericKeyCollector {
 public:
  template <typename T>
  void operator()(std::string_view name, T& field) {
    if constexpr (std::is_same_v<T, bool> || std::is_same_v<T, std::string> ||
                  requires { field.emplace_back(); }) {  // a list of structs
      return;
    } else {
      const std::string before = prefix_;
      prefix_ += std::string(name) + ".";
      visit_fields(*this, field);
      prefix_ = before;
    }
  }

  template <typename T, typename Least, typename Greatest>
  void operator()(std::string_view name, T& field, Least minimum, Greatest maximum) {
    const double low = static_cast<double>(minimum), high = static_cast<double>(maximum);
    const std::string key = fmt::format("{}{}", prefix_, name);
    if constexpr (std::is_same_v<T, std::uint64_t>) {
      return;                                            // seeds
    } else if constexpr (requires { field.reset(); }) {  // stated by hand or not at all
      return;
    } else if constexpr (std::is_arithmetic_v<T>) {
      keys.push_back({key, std::is_integral_v<T>, low, high, static_cast<double>(field)});
    } else {
      int index = 0;
      for (const auto value : field)
        keys.push_back({fmt::format("{}[{}]", key, index++), std::is_integral_v<decltype(value)>, low, high,
                        static_cast<double>(value)});
    }
  }

  template <typename T, std::size_t N>
  void operator()(std::string_view, T&, const std::array<std::pair<std::string_view, T>, N>&) {}

  std::vector<NumericKey> keys;

 private:
  std::string prefix_;
};

}  // namespace

std::vector<NumericKey> numeric_keys(Scenario scenario) {
  NumericKeyCollector collector;
  visit_fields(collector, scenario);
  return collector.keys;
}

}  // namespace understory
