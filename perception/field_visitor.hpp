#pragma once

#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <type_traits>
#include <utility>
#include <vector>

/// Names the fields of a configuration once, for all code that reads, writes, checks or lists them. Each
/// struct has a function beside it,
///   void visit_fields(FieldVisitor& visit, Config& config) {
///     visit("depth_m", config.depth_m, 0.1, 1000.0, "meaning | source | unit");
///   }
/// Source and unit may be left out. No folder's own types are used here, so each folder may include it.
namespace understory {

class FieldVisitor;
struct TextNode;

/// Visits the fields of one struct.
using Fields = std::function<void(FieldVisitor&)>;

/// The numbers of a field on their way to or from a visitor.
struct FieldNumbers {
  enum class Shape { one, optional, three, list };
  Shape shape = Shape::one;
  bool whole = false;               ///< whole numbers only
  double minimum = 0, maximum = 0;  ///< of each value, both included
  std::vector<double> values = {};  ///< optional: at most one; three: x, y, z
};

/// A list of structs.
struct FieldList {
  std::size_t size = 0;
  std::function<void(std::size_t size)> resize;  ///< to `size` entries with default values
  std::function<void(FieldVisitor& visit, std::size_t entry)> visit;  ///< entry >= `size`: a default entry
};

/// One function for each kind of field; by default it does nothing, but group() visits the fields. Plug-ins
/// use the program's visitors through it.
class FieldVisitor {
 public:
  using Shape = FieldNumbers::Shape;

  virtual ~FieldVisitor() = default;
  virtual void truth(std::string_view /*name*/, bool& /*value*/, std::string_view /*meaning*/) {}
  virtual void word(std::string_view /*name*/, std::string& /*value*/, std::string_view /*meaning*/) {}
  /// `chosen` is the index of one of `words`.
  virtual void choice(std::string_view /*name*/, std::size_t& /*chosen*/,
                      const std::vector<std::string>& /*words*/, std::string_view /*meaning*/) {}
  virtual void numbers(std::string_view /*name*/, FieldNumbers& /*numbers*/, std::string_view /*meaning*/) {}
  /// From 0 to `maximum`. A search does not vary it, because it only selects random numbers.
  virtual void seed(std::string_view /*name*/, std::uint64_t& /*value*/, std::uint64_t /*maximum*/,
                    std::string_view /*meaning*/) {}
  /// Any number of words.
  virtual void words(std::string_view /*name*/, std::vector<std::string>& /*values*/,
                     std::string_view /*meaning*/) {}
  /// Keys as written in the file, if only the struct's owner knows their names (perception/io/text_tree).
  virtual void tree(std::string_view /*name*/, TextNode& /*value*/, std::string_view /*meaning*/) {}
  virtual void group(std::string_view /*name*/, const Fields& fields) { fields(*this); }
  virtual void list(std::string_view /*name*/, const FieldList& /*list*/) {}

  // What visit_fields() calls.
  template <typename T>
  void operator()(std::string_view name, T& field, std::string_view meaning = "") {
    if constexpr (std::is_same_v<T, bool>) {
      truth(name, field, meaning);
    } else if constexpr (std::is_same_v<T, std::string>) {
      word(name, field, meaning);
    } else if constexpr (std::is_same_v<T, std::vector<std::string>>) {
      words(name, field, meaning);
    } else if constexpr (std::is_same_v<T, TextNode>) {
      tree(name, field, meaning);
    } else if constexpr (requires { field.emplace_back(); }) {
      list(name, {field.size(), [&](std::size_t size) { field.assign(size, {}); },
                  [&](FieldVisitor& visit, std::size_t entry) {
                    typename T::value_type at_defaults;
                    visit_fields(visit, entry < field.size() ? field[entry] : at_defaults);
                  }});
    } else {
      group(name, [&](FieldVisitor& visit) { visit_fields(visit, field); });
    }
  }

  /// A whole number, a number, an optional one, an Eigen::Vector3d, a vector of numbers, or a seed.
  template <typename T, typename Minimum, typename Maximum>
  requires std::is_arithmetic_v<Minimum>
  void operator()(std::string_view name, T& field, Minimum minimum, Maximum maximum,
                  std::string_view meaning = "") {
    if constexpr (std::is_same_v<T, std::uint64_t>) {
      seed(name, field, maximum, meaning);
    } else {
      FieldNumbers of_field = numbers_of(field);
      of_field.minimum = static_cast<double>(minimum);
      of_field.maximum = static_cast<double>(maximum);
      numbers(name, of_field, meaning);
      set_numbers(field, of_field.values);
    }
  }

  /// One of the words that stand for the values of an enumeration.
  template <typename T, std::size_t N>
  void operator()(std::string_view name, T& field, const std::array<std::pair<std::string_view, T>, N>& names,
                  std::string_view meaning = "") {
    std::size_t chosen = N;
    std::vector<std::string> words;
    for (const auto& [word, value] : names) {
      if (field == value) chosen = words.size();
      words.emplace_back(word);
    }
    choice(name, chosen, words, meaning);
    if (chosen < N) field = names[chosen].second;
  }

  void operator()(std::string_view name, std::string& field, const std::vector<std::string>& words,
                  std::string_view meaning = "") {
    std::size_t chosen = 0;
    while (chosen < words.size() && words[chosen] != field) ++chosen;
    choice(name, chosen, words, meaning);
    if (chosen < words.size()) field = words[chosen];
  }

 private:
  template <typename T>
  static FieldNumbers numbers_of(const T& field) {
    FieldNumbers numbers;
    if constexpr (std::is_arithmetic_v<T>) {
      numbers.whole = std::is_integral_v<T>;
      numbers.values = {static_cast<double>(field)};
    } else if constexpr (requires { field.has_value(); }) {
      numbers.shape = Shape::optional;
      numbers.whole = std::is_integral_v<typename T::value_type>;
      if (field) numbers.values = {static_cast<double>(*field)};
    } else {
      numbers.shape = std::is_same_v<T, Eigen::Vector3d> ? Shape::three : Shape::list;
      numbers.whole = std::is_integral_v<std::decay_t<decltype(field[0])>>;
      numbers.values.assign(field.begin(), field.end());
    }
    return numbers;
  }

  template <typename T>
  static void set_numbers(T& field, const std::vector<double>& values) {
    if constexpr (std::is_arithmetic_v<T>) {
      field = static_cast<T>(values[0]);
    } else if constexpr (requires { field.reset(); }) {
      field.reset();
      if (!values.empty()) field = static_cast<typename T::value_type>(values[0]);
    } else if constexpr (std::is_same_v<T, Eigen::Vector3d>) {
      field = {values[0], values[1], values[2]};
    } else {
      field.assign(values.begin(), values.end());
    }
  }
};

/// The fields of `config`, which must outlive them.
template <typename Config>
Fields fields_of(Config& config) {
  return [&config](FieldVisitor& visit) { visit_fields(visit, config); };
}

}  // namespace understory
