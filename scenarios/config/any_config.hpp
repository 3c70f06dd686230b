#pragma once

#include <memory>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "perception/field_visitor.hpp"

/// Configurations whose type only their own part has: those of plug-ins.
namespace understory {

/// A config struct with visit_fields(), its type erased.
class AnyConfig {
 public:
  virtual ~AnyConfig() = default;
  virtual std::unique_ptr<AnyConfig> clone() const = 0;
  virtual void visit(FieldVisitor& visit) = 0;
};

template <typename Config>
class TypedConfig : public AnyConfig {
 public:
  explicit TypedConfig(Config given) : config(std::move(given)) {}
  std::unique_ptr<AnyConfig> clone() const override { return std::make_unique<TypedConfig>(config); }
  void visit(FieldVisitor& visit) override { visit_fields(visit, config); }

  Config config;
};

inline void visit_fields(FieldVisitor& visit, AnyConfig& config) { config.visit(visit); }

/// Throws std::invalid_argument if these keys, once written, could not be read again: a name that is not a
/// plain word or is there twice, a value outside of its bounds. `part` begins the message.
void require_sound_keys(const std::string& part, const AnyConfig& keys);

/// The configurations of all parts of a kind that have keys, by the parts' names. Copies are deep.
class PartConfigs {
 public:
  struct Entry {
    std::string name;
    std::unique_ptr<AnyConfig> config;
    bool plugged = false;  ///< from a plug-in
  };
  PartConfigs() = default;
  PartConfigs(const PartConfigs& other) { *this = other; }
  PartConfigs(PartConfigs&&) = default;
  PartConfigs& operator=(PartConfigs&&) = default;
  PartConfigs& operator=(const PartConfigs& other) {
    std::vector<Entry> copies;
    for (const Entry& entry : other.entries)
      copies.push_back({entry.name, entry.config->clone(), entry.plugged});
    entries = std::move(copies);
    return *this;
  }

  /// Null where the part has no keys.
  const AnyConfig* find(std::string_view name) const {
    for (const Entry& entry : entries)
      if (entry.name == name) return entry.config.get();
    return nullptr;
  }

  /// The configuration of one of our parts, whose type the caller knows.
  template <typename Config>
  const Config& of(std::string_view name) const {
    return static_cast<const TypedConfig<Config>&>(*find(name)).config;
  }
  template <typename Config>
  Config& of(std::string_view name) {
    return const_cast<Config&>(std::as_const(*this).of<Config>(name));
  }

  std::vector<Entry> entries;
};

/// A group of keys for each part of ours, or of plug-ins, by its name.
inline void visit_parts(FieldVisitor& visit, PartConfigs& configs, bool plugged) {
  for (PartConfigs::Entry& entry : configs.entries)
    if (entry.plugged == plugged) visit(entry.name, *entry.config);
}
inline void visit_parts(FieldVisitor& visit, PartConfigs& configs) {
  visit_parts(visit, configs, false);
  visit_parts(visit, configs, true);
}

}  // namespace understory
