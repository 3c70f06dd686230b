#pragma once

#include <cstddef>
#include <string>

/// What this process may have of the machine.
namespace understory {

/// What the machine lacks where a call ended with this errno: memory, descriptors, a limit on the size of
/// files. In words, with the limit; empty where it is none of these.
std::string lacking_resource(int error);
/// What it lacks at this moment, for libraries that do not say why they failed.
std::string lacking_resource();
/// Throws MachineError where this process may not map `bytes` more.
void require_address_space(std::size_t bytes, const std::string& work);

/// Throws MachineError where this thread's stack is too small to fly, draw and call Python on.
void require_stack();

}  // namespace understory
