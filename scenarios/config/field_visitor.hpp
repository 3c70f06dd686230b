#pragma once

#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <memory>
#include <string>
#include <string_view>
#include <type_traits>
#include <typeinfo>
#include <utility>
#include <vector>

/// Configurations whose type only their owner knows: those of plug-ins. Whatever reads, writes and lists keys
/// meets them as AnyConfig.
namespace understory {

class FieldVisitor;

/// A config struct with visit_fields(), its type erased.
class AnyConfig {
 public:
  virtual ~AnyConfig() = default;
  virtual std::unique_ptr<AnyConfig> clone() const = 0;
  virtual void visit(FieldVisitor& visit) = 0;
};

/// The visitor of visit_fields() in a form that can cross the border of a library: one function for each type
/// of field. Numbers lie from `minimum` to `maximum`. `meaning` is what `understory keys` prints, in the
/// form "meaning | source | unit" (keys.hpp).
class FieldVisitor {
 public:
  virtual ~FieldVisitor() = default;
  virtual void field(std::string_view name, bool& value, std::string_view meaning) = 0;
  virtual void field(std::string_view name, std::string& value, std::string_view meaning) = 0;
  /// The value is one of `words`.
  virtual void field(std::string_view name, std::string& value, const std::vector<std::string>& words,
                     std::string_view meaning) = 0;
  virtual void field(std::string_view name, int& value, int minimum, int maximum,
                     std::string_view meaning) = 0;
  virtual void field(std::string_view name, double& value, double minimum, double maximum,
                     std::string_view meaning) = 0;
  virtual void field(std::string_view name, std::vector<double>& values, double minimum, double maximum,
                     std::string_view meaning) = 0;
  virtual void field(std::string_view name, Eigen::Vector3d& value, double minimum, double maximum,
                     std::string_view meaning) = 0;

  // What visit_fields() calls.
  void operator()(std::string_view name, bool& value, std::string_view meaning = "") {
    field(name, value, meaning);
  }
  void operator()(std::string_view name, std::string& value, std::string_view meaning = "") {
    field(name, value, meaning);
  }
  void operator()(std::string_view name, std::string& value, const std::vector<std::string>& words,
                  std::string_view meaning = "") {
    field(name, value, words, meaning);
  }
  template <typename Value, typename Least, typename Greatest>
  requires std::is_arithmetic_v<Least>
  void operator()(std::string_view name, Value& value, Least minimum, Greatest maximum,
                  std::string_view meaning = "") {
    using Bound = std::conditional_t<std::is_same_v<Value, int>, int, double>;
    field(name, value, static_cast<Bound>(minimum), static_cast<Bound>(maximum), meaning);
  }
};

template <typename Config>
class TypedConfig : public AnyConfig {
 public:
  explicit TypedConfig(Config given) : config(std::move(given)) {}
  std::unique_ptr<AnyConfig> clone() const override { return std::make_unique<TypedConfig>(config); }
  void visit(FieldVisitor& visit) override { visit_fields(visit, config); }

  Config config;
};

/// A reader, writer or lister of keys as a FieldVisitor.
template <typename Visitor>
class FieldVisitorOf : public FieldVisitor {
 public:
  explicit FieldVisitorOf(Visitor& visit) : visit_(visit) {}
  void field(std::string_view name, bool& value, std::string_view meaning) override {
    visit_(name, value, meaning);
  }
  void field(std::string_view name, std::string& value, std::string_view meaning) override {
    visit_(name, value, meaning);
  }
  void field(std::string_view name, std::string& value, const std::vector<std::string>& words,
             std::string_view meaning) override {
    visit_(name, value, words, meaning);
  }
  void field(std::string_view name, int& value, int minimum, int maximum, std::string_view meaning) override {
    visit_(name, value, minimum, maximum, meaning);
  }
  void field(std::string_view name, double& value, double minimum, double maximum,
             std::string_view meaning) override {
    visit_(name, value, minimum, maximum, meaning);
  }
  void field(std::string_view name, std::vector<double>& values, double minimum, double maximum,
             std::string_view meaning) override {
    visit_(name, values, minimum, maximum, meaning);
  }
  void field(std::string_view name, Eigen::Vector3d& value, double minimum, double maximum,
             std::string_view meaning) override {
    visit_(name, value, minimum, maximum, meaning);
  }

 private:
  Visitor& visit_;
};

template <typename Visitor>
void visit_fields(Visitor& visit, AnyConfig& config) {
  FieldVisitorOf<Visitor> fields(visit);
  config.visit(fields);
}

/// Throws std::invalid_argument where what is written of these keys cannot be read again: a name that is no
/// plain word or stands twice, a value outside of its bounds. `part` begins the message.
void require_sound_keys(const std::string& part, const AnyConfig& keys);

/// The configurations of the parts that plug-ins bring, by their names. Copies are deep.
class PartConfigs {
 public:
  struct Entry {
    std::string name;
    std::unique_ptr<AnyConfig> config;
  };
  PartConfigs() = default;
  PartConfigs(const PartConfigs& other) { *this = other; }
  PartConfigs(PartConfigs&&) = default;
  PartConfigs& operator=(PartConfigs&&) = default;
  PartConfigs& operator=(const PartConfigs& other) {
    std::vector<Entry> copies;
    for (const Entry& entry : other.entries) copies.push_back({entry.name, entry.config->clone()});
    entries = std::move(copies);
    return *this;
  }

  /// Null where the part has no keys.
  const AnyConfig* find(std::string_view name) const {
    for (const Entry& entry : entries)
      if (entry.name == name) return entry.config.get();
    return nullptr;
  }

  std::vector<Entry> entries;
};

/// A group of keys for each part, by its name.
template <typename Visitor>
void visit_parts(Visitor& visit, PartConfigs& configs) {
  for (PartConfigs::Entry& entry : configs.entries) visit(entry.name, *entry.config);
}

}  // namespace understory
