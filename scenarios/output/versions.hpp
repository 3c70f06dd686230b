#pragma once

namespace understory {

#ifdef UNDERSTORY_VERSION
inline constexpr const char* understory_version = UNDERSTORY_VERSION;
#else
inline constexpr const char* understory_version = "unknown";
#endif

}  // namespace understory
