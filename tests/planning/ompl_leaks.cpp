// OMPL 1.5.2's SST frees neither its witnesses' states nor the controls it set aside. That is OMPL's
// business: leak checks are for our own. Without a sanitizer nobody calls this.
extern "C" const char* __lsan_default_suppressions();
extern "C" const char* __lsan_default_suppressions() {
  return "leak:ompl::control::SST\nleak:ompl::control::RealVectorControlSpace\n";
}
