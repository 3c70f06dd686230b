#pragma once

#include <string>
#include <vector>

/// This very program.
namespace understory {

extern const char* const understory_version;  ///< "0.1.0"
/// What it was built from: "a1b2c3d4e5", "-dirty" behind it where files were changed since; "unknown" where
/// there was no git.
extern const char* const understory_commit;

/// Of the program's file. Equal programs give equal results.
std::string program_digest();

/// Makes the calling process, fresh from fork(), this program anew, with `arguments` (without its name);
/// exits with 127 where that fails.
[[noreturn]] void become_this_program(const std::vector<std::string>& arguments);

}  // namespace understory
