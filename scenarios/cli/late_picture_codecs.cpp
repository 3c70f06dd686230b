#include <dlfcn.h>

#include "perception/io/picture_codecs.hpp"
#include "scenarios/output/file_output.hpp"

namespace understory {
namespace {

constexpr const char* module_name = "understory_picture_codecs.so";

/// Found through the program's run path: beside it in the build folder, or where it was installed.
const PictureCodecs& opened_codecs() {
  using Entry = const PictureCodecs* (*)();
  void* module = dlopen(module_name, RTLD_NOW | RTLD_LOCAL);
  void* entry = module == nullptr ? nullptr : dlsym(module, "understory_picture_codecs");
  if (entry == nullptr)
    throw MachineError(std::string("pictures and films need a module that is built and installed with this "
                                   "program: ") +
                       dlerror());
  return *reinterpret_cast<Entry>(entry)();
}

}  // namespace

/// In place of perception/io's, which links OpenCV's libraries: the linker takes what the program itself
/// defines and leaves that one in its archive.
const PictureCodecs& picture_codecs() {
  static const PictureCodecs& codecs = opened_codecs();
  return codecs;
}

}  // namespace understory
