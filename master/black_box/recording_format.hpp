#pragma once
#include <string_view>
#include <tuple>
#include <utility>

#include "master/black_box/recording_file.hpp"

namespace takt::recording_format {

inline constexpr int version = 2;                      ///< version 1 has no checkpoints
inline constexpr std::string_view magic = "TAKTJNL1";  ///< words of 64 bits follow, little endian
inline constexpr const char* log_ending = ".log";
inline constexpr const char* journal_ending = ".journal";
inline constexpr const char* events_ending = ".events.json";
inline constexpr std::string_view incomplete = ".part-";  ///< prefix of unfinished files

// The names of the fields in the events file.

inline constexpr std::tuple head_fields{std::pair{"bus", &RecordingHead::bus},
                                        std::pair{"interface", &RecordingHead::interface},
                                        std::pair{"network", &RecordingHead::network},
                                        std::pair{"fingerprint", &RecordingHead::fingerprint},
                                        std::pair{"reason", &RecordingHead::reason},
                                        std::pair{"observe", &RecordingHead::observe},
                                        std::pair{"from_start", &RecordingHead::from_start},
                                        std::pair{"follows", &RecordingHead::follows}};

inline constexpr std::tuple decision_fields{
    std::pair{"time", &Decision::time},   std::pair{"cycle", &Decision::cycle},
    std::pair{"node", &Decision::node},   std::pair{"kind", &Decision::kind},
    std::pair{"value", &Decision::value}, std::pair{"detail", &Decision::detail},
    std::pair{"bytes", &Decision::bytes}, std::pair{"text", &Decision::text}};

}  // namespace takt::recording_format
