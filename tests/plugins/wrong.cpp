// Plug-ins that cannot be loaded, one for each WRONG_... that is defined.
#if defined(WRONG_NO_ENTRY)
extern "C" int something_else() { return 1; }
#elif defined(WRONG_STAMP)
extern "C" const char* understory_plugin_stamp() { return "headers of understory 0.0.1: 0123456789abcdef\n"; }
extern "C" void understory_plugin_add(void*) {}
#elif defined(WRONG_NULL_STAMP)
extern "C" const char* understory_plugin_stamp() { return nullptr; }
extern "C" void understory_plugin_add(void*) {}
#elif defined(WRONG_DATA_SYMBOL)
extern "C" {
int understory_plugin_stamp = 5, understory_plugin_add = 6;
}
#elif defined(WRONG_SYMBOL)
extern "C" int a_function_that_nobody_has();
extern "C" const char* understory_plugin_stamp() { return a_function_that_nobody_has() == 1 ? "" : "x"; }
extern "C" void understory_plugin_add(void*) {}
#else
#include <cstdlib>
#include <stdexcept>

#include "scenarios/scenario/plugin.hpp"

struct Backwards {
  double gain = 3;
};
template <typename Visitor>
void visit_fields(Visitor& visit, Backwards& keys) {
  visit("gain", keys.gain, 40.0, 2.0, "its bounds are the wrong way round");
}

UNDERSTORY_PLUGIN(parts) {
#if defined(WRONG_NAME_TAKEN)
  parts.detectors.add({.name = "mine", .meaning = "", .make = [](const understory::FlightContext& context) {
                         return understory::parts().detectors.find("none")->make(context);
                       }});
  parts.detectors.add(*parts.detectors.find("pushbroom"));
#elif defined(WRONG_NAME)
  auto part = *parts.detectors.find("none");
  part.name = "My Detector";
  parts.detectors.add(part);
#elif defined(WRONG_KEY)
  auto part = *parts.detectors.find("none");
  part.name = "compute";
  parts.detectors.add(part);
#elif defined(WRONG_THROWS)
  throw std::runtime_error("no licence for " + std::to_string(parts.detectors.all().size()));
#elif defined(WRONG_THROWS_INT)
  if (!parts.detectors.all().empty()) throw 5;
#elif defined(WRONG_EXITS)
  std::exit(parts.detectors.all().empty() ? 1 : 0);
#elif defined(WRONG_BOUNDS)
  parts.detectors.add({.name = "backwards",
                       .meaning = "",
                       .make =
                           [](const understory::FlightContext& context) {
                             return understory::parts().detectors.find("none")->make(context);
                           }},
                      Backwards{});
#else
  (void)parts;
#endif
}
#endif
