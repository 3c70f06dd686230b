#pragma once

#include <cstddef>
#include <string>

/// What this process may have of the machine.
namespace understory {

/// In words, the resource that the machine lacks if a call failed with this errno: memory, descriptors, or
/// size of files, with its limit; empty for any other errno.
std::string lacking_resource(int error);
/// The resource that it lacks at this moment, for libraries that do not report why they failed.
std::string lacking_resource();
/// Throws MachineError if this process may not map `bytes` more.
void require_address_space(std::size_t bytes, const std::string& work);

/// Throws MachineError if this thread's stack is too small to fly, draw and call Python on.
void require_stack();

}  // namespace understory
