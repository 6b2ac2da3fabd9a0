#pragma once
#include <string_view>

namespace takt::recording_format {

inline constexpr int version = 2;                      ///< 1: without checkpoints
inline constexpr std::string_view magic = "TAKTJNL1";  ///< then words of 64 bits, little endian
inline constexpr const char* log_ending = ".log";
inline constexpr const char* journal_ending = ".journal";
inline constexpr const char* events_ending = ".events.json";
inline constexpr std::string_view incomplete = ".part-";  ///< before the names of unfinished files

}  // namespace takt::recording_format
