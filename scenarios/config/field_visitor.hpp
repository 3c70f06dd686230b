#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <type_traits>
#include <typeinfo>
#include <utility>
#include <vector>

/// Config structs whose type is known to their makers alone: those of the parts of a flight (parts.hpp), of
/// plug-ins too. What reads, writes and lists keys meets them as AnyConfig.
namespace understory {

class FieldVisitor;

/// Words that a key may have, one of which it has.
using Words = std::vector<std::string>;

/// A config struct with visit_fields(), its type erased.
class AnyConfig {
 public:
  virtual ~AnyConfig() = default;
  virtual std::unique_ptr<AnyConfig> clone() const = 0;
  virtual void visit(FieldVisitor& visit) = 0;
  virtual const std::type_info& type() const = 0;  ///< of the struct
};

/// The visitor of visit_fields() in a form that can cross a library's border: a function for each kind of field.
/// Numbers lie from `minimum` to `maximum`.
class FieldVisitor {
 public:
  virtual ~FieldVisitor() = default;
  virtual void field(std::string_view name, bool& value) = 0;
  virtual void field(std::string_view name, std::string& value) = 0;
  virtual void field(std::string_view name, std::string& value, const Words& words) = 0;
  virtual void field(std::string_view name, int& value, int minimum, int maximum) = 0;
  virtual void field(std::string_view name, double& value, double minimum, double maximum) = 0;
  virtual void field(std::string_view name, std::optional<int>& value, int minimum, int maximum) = 0;
  virtual void field(std::string_view name, std::optional<double>& value, double minimum, double maximum) = 0;
  virtual void field(std::string_view name, std::vector<int>& values, int minimum, int maximum) = 0;
  virtual void field(std::string_view name, std::vector<double>& values, double minimum, double maximum) = 0;
  virtual void field(std::string_view name, Eigen::Vector3d& value, double minimum, double maximum) = 0;
  virtual void field(std::string_view name, AnyConfig& group) = 0;

  // What visit_fields() calls.
  void operator()(std::string_view name, bool& value) { field(name, value); }
  void operator()(std::string_view name, std::string& value) { field(name, value); }
  void operator()(std::string_view name, std::string& value, const Words& words) { field(name, value, words); }
  void operator()(std::string_view name, AnyConfig& group) { field(name, group); }
  template <typename Group>
  void operator()(std::string_view name, Group& group);
  template <typename Value, typename Least, typename Greatest>
  void operator()(std::string_view name, Value& value, Least minimum, Greatest maximum) {
    using Bound = std::conditional_t<is_whole<Value>, int, double>;
    field(name, value, static_cast<Bound>(minimum), static_cast<Bound>(maximum));
  }
  template <typename Value, std::size_t N>
  void operator()(std::string_view name, Value& value,
                  const std::array<std::pair<std::string_view, Value>, N>& names);

 private:
  template <typename Value>
  static constexpr bool is_whole = std::is_same_v<Value, int> || std::is_same_v<Value, std::optional<int>> ||
                                   std::is_same_v<Value, std::vector<int>>;
};

/// A struct as AnyConfig: its own (Config) or somebody else's (Config&).
template <typename Config>
class TypedConfig : public AnyConfig {
 public:
  explicit TypedConfig(Config given) : config(static_cast<Config&&>(given)) {}
  std::unique_ptr<AnyConfig> clone() const override {
    return std::make_unique<TypedConfig<std::remove_reference_t<Config>>>(config);
  }
  void visit(FieldVisitor& visit) override { visit_fields(visit, config); }
  const std::type_info& type() const override { return typeid(Config); }

  Config config;
};

template <typename Group>
void FieldVisitor::operator()(std::string_view name, Group& group) {
  TypedConfig<Group&> any(group);
  field(name, any);
}

template <typename Value, std::size_t N>
void FieldVisitor::operator()(std::string_view name, Value& value,
                              const std::array<std::pair<std::string_view, Value>, N>& names) {
  Words words;
  std::string word;
  for (const auto& [its_word, meaning] : names) {
    words.emplace_back(its_word);
    if (value == meaning) word = its_word;
  }
  field(name, word, words);
  for (const auto& [its_word, meaning] : names)
    if (word == its_word) value = meaning;
}

/// Any other visitor as a FieldVisitor.
template <typename Visitor>
class FieldVisitorOf : public FieldVisitor {
 public:
  explicit FieldVisitorOf(Visitor& visit) : visit_(visit) {}
  void field(std::string_view name, bool& value) override { visit_(name, value); }
  void field(std::string_view name, std::string& value) override { visit_(name, value); }
  void field(std::string_view name, std::string& value, const Words& words) override { visit_(name, value, words); }
  void field(std::string_view name, int& value, int minimum, int maximum) override {
    visit_(name, value, minimum, maximum);
  }
  void field(std::string_view name, double& value, double minimum, double maximum) override {
    visit_(name, value, minimum, maximum);
  }
  void field(std::string_view name, std::optional<int>& value, int minimum, int maximum) override {
    visit_(name, value, minimum, maximum);
  }
  void field(std::string_view name, std::optional<double>& value, double minimum, double maximum) override {
    visit_(name, value, minimum, maximum);
  }
  void field(std::string_view name, std::vector<int>& value, int minimum, int maximum) override {
    visit_(name, value, minimum, maximum);
  }
  void field(std::string_view name, std::vector<double>& value, double minimum, double maximum) override {
    visit_(name, value, minimum, maximum);
  }
  void field(std::string_view name, Eigen::Vector3d& value, double minimum, double maximum) override {
    visit_(name, value, minimum, maximum);
  }
  void field(std::string_view name, AnyConfig& group) override { visit_(name, group); }

 private:
  Visitor& visit_;
};

template <typename Visitor>
void visit_fields(Visitor& visit, AnyConfig& config) {
  FieldVisitorOf<Visitor> fields(visit);
  config.visit(fields);
}

}  // namespace understory
