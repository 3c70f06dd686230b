# understory_add_plugin(NAME file.cpp ...): a shared library NAME.so with parts of one's own (docs/integrate.md). It is
# compiled as the program that loads it was, and finds the program's functions in the program.
function(understory_add_plugin name)
  add_library(${name} MODULE ${ARGN})
  set_target_properties(${name} PROPERTIES PREFIX "" CXX_STANDARD 20 CXX_STANDARD_REQUIRED ON CXX_EXTENSIONS OFF)
  target_link_libraries(${name} PRIVATE understory::plugin)
endfunction()
