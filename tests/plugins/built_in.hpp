#pragma once

#include "scenarios/scenario/plugin.hpp"

/// Makes an example plug-in a part of ours: what adds it is a function that the table of parts calls.
#undef UNDERSTORY_PLUGIN
#define UNDERSTORY_PLUGIN(parts) \
  namespace understory {         \
  void ADD_PARTS(Parts& parts);  \
  }                              \
  void understory::ADD_PARTS(Parts& parts)
