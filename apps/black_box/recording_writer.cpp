#include <cerrno>
#include <cstring>
#include <fmt/format.h>
#include <fstream>
#include <nlohmann/json.hpp>

#include "apps/black_box/recording_file.hpp"
#include "apps/black_box/recording_format.hpp"
#include "apps/black_box/unravel.hpp"

namespace takt {
namespace {

std::string frame_text(const Frame& frame) {
  std::string text = frame.id.is_extended() ? fmt::format("{:08X}#", frame.id.id())
                                            : fmt::format("{:03X}#", frame.id.id());
  if (frame.rtr) return text + (frame.length == 0 ? "R" : fmt::format("R{}", frame.length));
  for (const std::uint8_t byte : frame.payload())
    fmt::format_to(std::back_inserter(text), "{:02X}", byte);
  return text;
}

void write_log(std::ostream& out, const UnravelledTape& tape, const std::string& interface) {
  for (const LoggedFrame& logged : tape.frames) {
    const std::int64_t us = (logged.when + tape.since_1970).count() / 1000;
    out << fmt::format("({:010}.{:06}) {} {}\n", us / 1'000'000, us % 1'000'000, interface,
                       frame_text(logged.frame));
  }
}

void write_journal(std::ostream& out, const std::vector<std::uint64_t>& words) {
  out.write(recording_format::magic.data(), recording_format::magic.size());
  out.write(reinterpret_cast<const char*>(words.data()),
            static_cast<std::streamsize>(words.size() * sizeof(std::uint64_t)));
}

void write_events(std::ostream& out, const BusPlan& plan, const RecordingHead& head,
                  const UnravelledTape& tape) {
  nlohmann::ordered_json json{{"format", recording_format::version},
                              {"bus", head.bus},
                              {"interface", head.interface},
                              {"network", head.network},
                              {"fingerprint", head.fingerprint},
                              {"reason", head.reason},
                              {"observe", head.observe},
                              {"from_start", head.from_start},
                              {"follows", head.follows},
                              {"frames", tape.frames.size()},
                              {"events", nlohmann::ordered_json::array()}};
  for (const Event& event : tape.events) {
    const Decision decision = to_decision(plan, event);
    json["events"].push_back({{"time", decision.time},
                              {"utime", (event.when + tape.since_1970).count() / 1000},
                              {"cycle", decision.cycle},
                              {"node", decision.node},
                              {"kind", decision.kind},
                              {"value", decision.value},
                              {"detail", decision.detail},
                              {"bytes", decision.bytes},
                              {"text", decision.text}});
  }
  out << json.dump(1, ' ', false, nlohmann::json::error_handler_t::replace) << '\n';
}

/// candump separates by blanks.
std::string interface_of(const BusPlan& plan) {
  std::string text = plan.interface.empty() ? plan.name : plan.interface;
  for (char& letter : text) {
    if (letter <= ' ' || letter == '#') letter = '_';
  }
  return text.empty() ? "bus" : text;
}

template <class F>
std::expected<void, std::string> write_file(const std::string& path, F&& write) {
  std::ofstream file{path, std::ios::binary | std::ios::trunc};
  if (file) write(file);
  file.flush();
  if (file) return {};
  return std::unexpected{path + ": can't be written: " + std::strerror(errno)};
}

}  // namespace

std::expected<void, std::string> write_recording(const std::filesystem::path& stem,
                                                 const BusPlan& plan, const RecordingHead& head,
                                                 const std::vector<std::uint64_t>& records) {
  const UnravelledTape tape = unravel(records);
  RecordingHead told = head;
  told.from_start = !records.empty() && journal::mark_of(records.front()) == Mark::now;
  const std::string path = stem.string();
  auto result = write_file(path + recording_format::log_ending,
                           [&](std::ostream& out) { write_log(out, tape, interface_of(plan)); });
  if (result) {
    result = write_file(path + recording_format::journal_ending,
                        [&](std::ostream& out) { write_journal(out, tape.words); });
  }
  if (!result) return result;
  return write_file(path + recording_format::events_ending,
                    [&](std::ostream& out) { write_events(out, plan, told, tape); });
}

}  // namespace takt
