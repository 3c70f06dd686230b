#pragma once

#include <string>

namespace understory {

/// Of this program's own file. Equal programs give equal results.
std::string program_digest();

}  // namespace understory
