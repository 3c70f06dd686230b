#include "scenarios/tuning/search.hpp"

/// The way into understory_evolution.so, by a name that dlsym can find.
extern "C" const understory::EvolutionMethods* understory_evolution() {
  static const understory::EvolutionMethods methods{understory::search_by_cma_es,
                                                    understory::search_by_nsga2};
  return &methods;
}
