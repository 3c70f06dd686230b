// OMPL 1.5.2's SST frees neither its witnesses' states nor the controls it set aside. Leak checks are for our
// own memory. Without a sanitizer nobody calls this.
extern "C" const char* __lsan_default_suppressions();
extern "C" const char* __lsan_default_suppressions() {
  return "leak:ompl::control::SST\nleak:ompl::control::RealVectorControlSpace\n";
}
