#include <dlfcn.h>

#include <string>

#include "scenarios/output/errors.hpp"
#include "scenarios/tuning/search.hpp"

namespace understory {
namespace {

/// Found as the module of picture codecs is (late_picture_codecs.cpp).
const EvolutionMethods& opened_methods() {
  using Entry = const EvolutionMethods* (*)();
  void* module = dlopen("understory_evolution.so", RTLD_NOW | RTLD_LOCAL);
  void* entry = module == nullptr ? nullptr : dlsym(module, "understory_evolution");
  if (entry == nullptr)
    throw MachineError(std::string("cma_es and nsga2 need a module that is built and installed with this "
                                   "program: ") +
                       dlerror());
  return *reinterpret_cast<Entry>(entry)();
}

const EvolutionMethods& methods() {
  static const EvolutionMethods& opened = opened_methods();
  return opened;
}

}  // namespace

/// In place of tuning/evolution.cpp's, which link the library.
void search_by_cma_es(const Space& space, const Objective& objective, const SearchConfig& config,
                      const Evaluate& evaluate) {
  methods().cma_es(space, objective, config, evaluate);
}

void search_by_nsga2(const Space& space, const Objective& objective, const SearchConfig& config,
                     const Evaluate& evaluate) {
  methods().nsga2(space, objective, config, evaluate);
}

}  // namespace understory
