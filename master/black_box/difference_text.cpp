#include "master/black_box/difference_text.hpp"

#include <fmt/format.h>
#include <string_view>

#include "eds_parser/values/name_of.hpp"
#include "master/trace/candump_line.hpp"

namespace takt {
namespace {

std::string_view call_text(Mark mark) noexcept {
  static constexpr std::string_view unknown = "does something unknown";
  static constexpr std::string_view names[]{unknown,
                                            "begins the next cycle",
                                            "reads the clock",
                                            "waits for a frame",
                                            "takes the received frames",
                                            "sends frames",
                                            "reads the state of the interface",
                                            "takes the set-points",
                                            "takes a request",
                                            "receives a stop request",
                                            "can't pass on a reply",
                                            "reports an event",
                                            "receives data that was too long to record",
                                            "saves a checkpoint",
                                            "takes a message about motions"};
  return name_of(mark, names, unknown);
}

std::string place(std::uint64_t cycle, std::int64_t ns) {
  return fmt::format("cycle {}, {}.{:06} s: ", cycle, ns / 1'000'000'000,
                     ns % 1'000'000'000 / 1000);
}

std::string words_of(const Frame& frame) { return to_string(CandumpLine{.frame = frame}); }

std::string what_differs(const ReplayDifference& difference, const std::string& log) {
  using What = ReplayDifference::What;
  switch (difference.what) {
    case What::call:
      return fmt::format("the master {}, in the recording it {}", call_text(difference.asked),
                         call_text(difference.recorded));
    case What::frame:
      return fmt::format("the master sends{}, in the recording{} ({}:{})",
                         words_of(difference.sent), words_of(difference.expected), log,
                         difference.line + 1);
    case What::count:
      return fmt::format("the master handles {} frames or set-points at once, in the recording {}",
                         difference.counted, difference.counted_before);
    case What::cycle:
      return fmt::format("in the recording this is cycle {}", difference.counted_before);
    case What::broken:
      return "the journal is damaged here";
    case What::missing:
      return "a request or a receive was too long for the black box; the replay can't continue";
  }
  return {};
}

std::string one_line(const Decision& decision) {
  return decision.text.substr(0, decision.text.find('\n'));
}

}  // namespace

std::string difference_text(const ReplayDifference& difference,
                            const std::vector<std::string>& logs) {
  const std::string log = difference.part < logs.size() ? logs[difference.part] : "";
  return place(difference.cycle, difference.when.count()) + what_differs(difference, log);
}

std::string decision_text(const Decision& recorded, const Decision& decision) {
  std::string text = place(decision.cycle, decision.time);
  const std::string was = one_line(recorded);
  const std::string is = one_line(decision);
  if (was != is) return text + fmt::format("{}; in the recording: {}", is, was);
  if (recorded.time != decision.time || recorded.cycle != decision.cycle) {
    return text + fmt::format("{}; in the recording at cycle {}, {} ns", is, recorded.cycle,
                              recorded.time);
  }
  return text + fmt::format("{}; in the recording with other details", is);
}

std::string surplus_text(const Decision& decision) {
  return place(decision.cycle, decision.time) + one_line(decision) + "; not in the recording";
}

std::string lack_text(const Decision& recorded) {
  return place(recorded.cycle, recorded.time) + one_line(recorded) + "; only in the recording";
}

}  // namespace takt
