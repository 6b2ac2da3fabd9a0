#include "apps/takt/simulate/fault_file.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <span>
#include <string_view>
#include <utility>
#include <yaml-cpp/yaml.h>

#include "apps/command_line/live_arguments.hpp"
#include "apps/takt/simulate/entry_reader.hpp"
#include "apps/takt/simulate/motion_list_reader.hpp"
#include "eds_parser/ini/number.hpp"
#include "eds_parser/report/suggest.hpp"
#include "eds_parser/values/little_endian.hpp"

namespace takt {
namespace {

constexpr std::array<std::string_view, 14> keys{
    "kind", "node",   "at",     "for",        "until", "time",      "probability",
    "ppm",  "cob_id", "object", "abort_code", "value", "emcy_code", "data"};
constexpr Time shortest_step = std::chrono::microseconds{100};
constexpr Time longest_step = std::chrono::hours{1};

std::vector<std::string_view> kinds() {
  std::vector<std::string_view> all;
  for (unsigned kind = 0;; ++kind) {
    const auto known = sim::name(static_cast<sim::FaultKind>(kind));
    if (!sim::fault_kind(known)) break;
    all.push_back(known);
  }
  for (const std::string_view program : program_fault_names()) all.push_back(program);
  return all;
}

std::optional<std::uint64_t> integer(const std::string& text) {
  const auto number = parse_number(text);
  if (!number || number->relative()) return std::nullopt;
  return number->negative ? ~number->magnitude + 1 : number->magnitude;
}

/// Reads the entries of the lists and collects the errors.
class Reader : public EntryReader {
 public:
  Reader(const std::string& file, const BusPlan& plan, std::size_t applications)
      : EntryReader{file, result_.findings},
        plan_{plan},
        applications_{applications},
        motions_{*this, plan} {}

  FaultFile take() {
    result_.motions = motions_.take();
    return std::move(result_);
  }

  void read(const YAML::Node& root) {
    const YAML::Node faults = root.IsMap() ? root["faults"] : YAML::Node{};
    const YAML::Node motions = root.IsMap() ? root["motions"] : YAML::Node{};
    const auto is_list = [](const YAML::Node& part) { return part && part.IsSequence(); };
    const auto lists = std::size_t{is_list(faults)} + std::size_t{is_list(motions)};
    if (!root.IsMap() || lists == 0 || root.size() != lists) {
      error(root.Mark(), "fault-file",
            "a fault file is a list under `faults:`, one under `motions:`, or both");
      return;
    }
    if (motions) motions_.read(motions);
    if (!faults) return;
    for (const YAML::Node& entry : faults) read_fault(entry);
  }

 private:
  void read_fault(const YAML::Node& entry) {
    if (!entry.IsMap()) {
      error(entry.Mark(), "fault-file", "a fault is a map with at least `kind:`");
      return;
    }
    const YAML::Node kind = entry["kind"];
    const auto program = program_fault_kind(kind ? kind.as<std::string>("") : "");
    if (program) return read_program_fault(entry, *program);
    sim::Fault fault;
    for (const auto& pair : entry) {
      const EntryItem item{pair};
      if (item.is_scalar) {
        read_key(fault, item);
      } else {
        error(item.mark, "fault-value", "`" + item.key + "` needs a single value");
      }
    }
    if (!kind) error(entry.Mark(), "fault-kind", "`kind` is missing");
    settle_end(fault.at, fault.until);
    result_.faults.push_back(std::move(fault));
  }

  /// Makes the end of the fault absolute: `for` counts from the beginning of the fault.
  void settle_end(Time at, Time& until) {
    const bool absolute = std::exchange(until_is_absolute_, false);
    if (until != never && !absolute) until += at;
  }

  void read_program_fault(const YAML::Node& entry, ProgramFaultKind kind) {
    ProgramFault fault{.kind = kind};
    const bool has_programs = !motions_.is_empty() && !concerns_application(kind);
    if (applications_ == 0 && !has_programs) {
      error(entry.Mark(), "fault-kind",
            "`" + std::string{name(kind)} +
                "` concerns programs, but there is no program: add `--applications 1`");
    }
    for (const auto& pair : entry) {
      const EntryItem item{pair};
      if (item.key == "kind" || read_span(fault, item)) continue;
      if (item.key == "time") {
        read_step(fault.time, item);
      } else if (item.key == "application" && concerns_application(kind)) {
        read_application(fault, item);
      } else {
        error(item.key_mark, "unknown-key",
              "`" + item.key + "` has no meaning for `" + std::string{name(kind)} + "`");
      }
    }
    settle_end(fault.at, fault.until);
    result_.programs.push_back(fault);
  }

  /// Reads a key of the time in which a fault lasts. Returns false for other keys.
  template <class Fault>
  bool read_span(Fault& fault, const EntryItem& item) {
    if (item.key == "at") {
      read_time(fault.at, item);
      return true;
    }
    if (item.key != "for" && item.key != "until") return false;
    until_is_absolute_ = item.key == "until";
    read_time(fault.until, item);
    return true;
  }

  /// Reads the interval of a repeated action, or a delay.
  void read_step(Time& time, const EntryItem& item) {
    read_time(time, item);
    if (time < shortest_step || time > longest_step) refuse(item, "a time of 100us to 1h");
  }

  void read_application(ProgramFault& fault, const EntryItem& item) {
    const auto number = integer(item.text);
    if (!number || *number < 1 || (applications_ != 0 && *number > applications_)) {
      return refuse(item, "the number of an application, counted from 1");
    }
    fault.application = *number - 1;
  }

  void read_key(sim::Fault& fault, const EntryItem& item) {
    if (read_span(fault, item)) return;
    if (item.key == "kind") return read_kind(fault, item);
    if (item.key == "node") return read_node(fault, item);
    if (item.key == "time") return read_time(fault.time, item);
    if (item.key == "probability") return read_probability(fault, item);
    if (item.key == "data") return read_data(fault, item);
    if (item.key == "value") return read_value(fault, item.text);
    if (item.key != "object") return read_number(fault, item);
    fault.object = parse_object(item.text);
    if (!fault.object) refuse(item, "an object like 6041:00");
  }

  /// Reads a value of an object: a number if the text is one, otherwise the text.
  static void read_value(sim::Fault& fault, const std::string& text) {
    if (const auto number = integer(text)) {
      fault.value = little_endian(static_cast<std::int64_t>(*number), 8);
    } else {
      const auto bytes = std::as_bytes(std::span{text});
      fault.value.assign(bytes.begin(), bytes.end());
    }
  }

  void read_number(sim::Fault& fault, const EntryItem& item) {
    const auto number = integer(item.text);
    const auto small = static_cast<std::int64_t>(number.value_or(0));
    bool in_range = true;
    if (item.key == "ppm") {
      in_range = small >= -50'000 && small <= 50'000;
      fault.ppm = static_cast<int>(small);
    } else if (item.key == "cob_id") {
      in_range = small >= 0 && small <= 0x1FFF'FFFF;
      const auto id = static_cast<std::uint32_t>(small);
      fault.cob_id = id > 0x7FF ? CobId::extended(id) : CobId::base(id);
    } else if (item.key == "abort_code") {
      in_range = small > 0 && small <= 0xFFFF'FFFF;
      fault.abort_code = static_cast<std::uint32_t>(small);
    } else if (item.key == "emcy_code") {
      in_range = small > 0 && small <= 0xFFFF;
      fault.emcy_code = static_cast<std::uint16_t>(small);
    } else {
      return error(item.key_mark, "unknown-key",
                   "unknown key `" + item.key + "`" + did_you_mean(item.key, keys));
    }
    if (!number || !in_range) refuse(item, "a number in the range of `" + item.key + "`");
  }

  void read_kind(sim::Fault& fault, const EntryItem& item) {
    const auto kind = sim::fault_kind(item.text);
    if (kind) {
      fault.kind = *kind;
    } else {
      error(item.mark, "fault-kind",
            "unknown kind `" + item.text + "`" + did_you_mean(item.text, kinds()));
    }
  }

  void read_node(sim::Fault& fault, const EntryItem& item) {
    const auto number = integer(item.text);
    for (const NodePlan& node : plan_.nodes) {
      if (node.name == item.text || (number && node.id.value() == *number)) fault.node = node.id;
    }
    if (!fault.node) refuse(item, "a node of the network, by name or number");
  }

  void read_probability(sim::Fault& fault, const EntryItem& item) {
    const auto parsed = parse_real(item.text);
    if (!parsed || !(*parsed >= 0.0 && *parsed <= 1.0)) return refuse(item, "0 to 1");
    fault.probability = *parsed;
  }

  void read_data(sim::Fault& fault, const EntryItem& item) {
    const std::string& text = item.text;
    unsigned byte = 0;
    for (std::size_t i = 0; i < text.size(); i += 2) {
      const char* begin = text.data() + i;
      const char* end = text.data() + std::min(i + 2, text.size());
      const auto parsed = std::from_chars(begin, end, byte, 16);
      if (parsed.ec != std::errc{} || parsed.ptr != end || i >= 16) {
        return refuse(item, "up to eight bytes in hex, like 0102FF");
      }
      fault.value.push_back(std::byte(byte));
    }
  }

  FaultFile result_;
  const BusPlan& plan_;
  std::size_t applications_;
  MotionListReader motions_;
  bool until_is_absolute_ = false;
};

}  // namespace

FaultFile read_fault_file(const std::filesystem::path& path, const BusPlan& plan,
                          std::size_t applications) {
  Reader reader{path.string(), plan, applications};
  std::error_code ignored;
  if (std::filesystem::is_directory(path, ignored)) {  // yaml-cpp would leak memory
    reader.error(YAML::Mark::null_mark(), "fault-file", "is a folder");
    return reader.take();
  }
  try {
    reader.read(YAML::LoadFile(path.string()));
  } catch (const YAML::BadFile&) {
    reader.error(YAML::Mark::null_mark(), "fault-file", "can't be read");
  } catch (const YAML::Exception& exception) {
    reader.error(exception.mark, "yaml", exception.msg);
  }
  return reader.take();
}

}  // namespace takt
