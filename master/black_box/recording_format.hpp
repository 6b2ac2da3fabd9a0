#pragma once
#include <string_view>

namespace takt::recording_format {

inline constexpr int version = 2;                      ///< version 1 has no checkpoints
inline constexpr std::string_view magic = "TAKTJNL1";  ///< words of 64 bits follow, little endian
inline constexpr const char* log_ending = ".log";
inline constexpr const char* journal_ending = ".journal";
inline constexpr const char* events_ending = ".events.json";
inline constexpr std::string_view incomplete = ".part-";  ///< prefix of unfinished files

}  // namespace takt::recording_format
