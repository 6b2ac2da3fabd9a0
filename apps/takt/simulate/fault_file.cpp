#include "apps/takt/simulate/fault_file.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <span>
#include <string_view>
#include <utility>
#include <yaml-cpp/yaml.h>

#include "apps/command_line/duration.hpp"
#include "eds_parser/ini/number.hpp"
#include "eds_parser/report/suggest.hpp"

namespace takt {
namespace {

constexpr std::array<std::string_view, 12> keys{"kind",   "node",   "at",          "for",
                                                "until",  "time",   "probability", "ppm",
                                                "cob_id", "object", "abort_code",  "value"};
constexpr std::array<std::string_view, 2> more_keys{"emcy_code", "data"};
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

std::vector<std::byte> little_endian(std::uint64_t value) {
  std::vector<std::byte> bytes;
  for (unsigned i = 0; i < 8; ++i) bytes.push_back(std::byte(value >> (8 * i) & 0xFF));
  return bytes;
}

std::optional<std::uint64_t> integer(const std::string& text) {
  const auto number = parse_number(text);
  if (!number || number->relative()) return std::nullopt;
  return number->negative ? ~number->magnitude + 1 : number->magnitude;
}

/// Parses index and sub-index in hex, for example `1018:01`, `0x1018:1` or `6040`.
std::optional<ObjectKey> object_key(std::string_view text) {
  if (text.starts_with("0x") || text.starts_with("0X")) text.remove_prefix(2);
  unsigned index = 0;
  unsigned sub = 0;
  const char* end = text.data() + text.size();
  auto [at, error] = std::from_chars(text.data(), end, index, 16);
  if (error != std::errc{} || index > 0xFFFF) return std::nullopt;
  if (at != end && *at == ':') {
    const auto rest = std::from_chars(at + 1, end, sub, 16);
    if (rest.ec != std::errc{} || sub > 0xFF) return std::nullopt;
    at = rest.ptr;
  }
  if (at != end) return std::nullopt;
  return ObjectKey{static_cast<std::uint16_t>(index), static_cast<std::uint8_t>(sub)};
}

/// Reads one list entry after the other and collects the errors.
class Reader {
 public:
  Reader(std::string file, const BusPlan& plan, std::size_t applications)
      : file_{std::move(file)}, plan_{plan}, applications_{applications} {}

  FaultFile take() { return std::move(result_); }

  void error(const YAML::Mark& mark, std::string_view rule, std::string message) {
    SourcePos pos;
    if (mark.line >= 0) {
      pos = {static_cast<std::uint32_t>(mark.line + 1),
             static_cast<std::uint32_t>(mark.column + 1)};
    }
    result_.findings.push_back({.file = file_,
                                .pos = pos,
                                .severity = Severity::error,
                                .rule = rule,
                                .message = std::move(message)});
  }

  void read(const YAML::Node& root) {
    if (!root.IsMap() || root.size() != 1 || !root["faults"] || !root["faults"].IsSequence()) {
      error(root.Mark(), "fault-file", "a fault file is a list under `faults:`");
      return;
    }
    for (const YAML::Node& entry : root["faults"]) read_fault(entry);
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
    bool has_kind = false;
    for (const auto& item : entry) {
      const auto key = item.first.as<std::string>("");
      has_kind |= key == "kind";
      if (!item.second.IsScalar()) {
        error(item.second.Mark(), "fault-value", "`" + key + "` needs a single value");
        continue;
      }
      read_key(fault, key, item.second, item.first.Mark());
    }
    if (!has_kind) error(entry.Mark(), "fault-kind", "`kind` is missing");
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
    if (applications_ == 0) {
      error(entry.Mark(), "fault-kind",
            "`" + std::string{name(kind)} +
                "` concerns programs, but there is no program: add `--applications 1`");
    }
    for (const auto& item : entry) {
      const auto key = item.first.as<std::string>("");
      const auto text = item.second.IsScalar() ? item.second.as<std::string>("") : std::string{};
      const YAML::Mark mark = item.second.Mark();
      if (key == "kind") continue;
      if (key == "at") {
        read_time(fault.at, text, mark);
      } else if (key == "for" || key == "until") {
        until_is_absolute_ = key == "until";
        read_time(fault.until, text, mark);
      } else if (key == "time") {
        read_step(fault.time, text, mark);
      } else if (key == "application" && concerns_application(kind)) {
        read_application(fault, text, mark);
      } else {
        error(item.first.Mark(), "unknown-key",
              "`" + key + "` has no meaning for `" + std::string{name(kind)} + "`");
      }
    }
    settle_end(fault.at, fault.until);
    result_.programs.push_back(fault);
  }

  /// Reads the interval of a repeated action, or a delay.
  void read_step(Time& time, const std::string& text, const YAML::Mark& mark) {
    read_time(time, text, mark);
    if (time < shortest_step || time > longest_step) refuse(mark, text, "a time of 100us to 1h");
  }

  void read_application(ProgramFault& fault, const std::string& text, const YAML::Mark& mark) {
    const auto number = integer(text);
    if (!number || *number < 1 || (applications_ != 0 && *number > applications_)) {
      return refuse(mark, text, "the number of an application, counted from 1");
    }
    fault.application = *number - 1;
  }

  void read_key(sim::Fault& fault, const std::string& key, const YAML::Node& value,
                const YAML::Mark& mark) {
    const auto text = value.as<std::string>("");
    if (key == "kind") return read_kind(fault, text, value.Mark());
    if (key == "node") return read_node(fault, text, value.Mark());
    if (key == "at") return read_time(fault.at, text, value.Mark());
    if (key == "for") return read_time(fault.until, text, value.Mark());
    if (key == "time") return read_time(fault.time, text, value.Mark());
    if (key == "until") {
      until_is_absolute_ = true;
      return read_time(fault.until, text, value.Mark());
    }
    if (key == "object") {
      fault.object = object_key(text);
      if (!fault.object) refuse(value.Mark(), text, "an object like 6041:00");
      return;
    }
    if (key == "probability") return read_probability(fault, text, value.Mark());
    if (key == "data") return read_data(fault, text, value.Mark());
    read_number(fault, key, value, mark);
  }

  void read_number(sim::Fault& fault, const std::string& key, const YAML::Node& value,
                   const YAML::Mark& mark) {
    const auto text = value.as<std::string>("");
    const auto number = integer(text);
    const auto small = static_cast<std::int64_t>(number.value_or(0));
    if (key == "value") {
      if (number) {
        fault.value = little_endian(*number);
      } else {
        const auto bytes = std::as_bytes(std::span{text});
        fault.value.assign(bytes.begin(), bytes.end());
      }
      return;
    }
    bool in_range = true;
    if (key == "ppm") {
      in_range = small >= -50'000 && small <= 50'000;
      fault.ppm = static_cast<int>(small);
    } else if (key == "cob_id") {
      in_range = small >= 0 && small <= 0x1FFF'FFFF;
      const auto id = static_cast<std::uint32_t>(small);
      fault.cob_id = id > 0x7FF ? CobId::extended(id) : CobId::base(id);
    } else if (key == "abort_code") {
      in_range = small > 0 && small <= 0xFFFF'FFFF;
      fault.abort_code = static_cast<std::uint32_t>(small);
    } else if (key == "emcy_code") {
      in_range = small > 0 && small <= 0xFFFF;
      fault.emcy_code = static_cast<std::uint16_t>(small);
    } else {
      const bool late = !did_you_mean(key, more_keys).empty();
      error(mark, "unknown-key",
            "unknown key `" + key + "`" +
                (late ? did_you_mean(key, more_keys) : did_you_mean(key, keys)));
      return;
    }
    if (!number || !in_range) refuse(value.Mark(), text, "a number in the range of `" + key + "`");
  }

  void read_kind(sim::Fault& fault, const std::string& text, const YAML::Mark& mark) {
    const auto kind = sim::fault_kind(text);
    if (kind) {
      fault.kind = *kind;
    } else {
      error(mark, "fault-kind", "unknown kind `" + text + "`" + did_you_mean(text, kinds()));
    }
  }

  void read_node(sim::Fault& fault, const std::string& text, const YAML::Mark& mark) {
    const auto number = integer(text);
    for (const NodePlan& node : plan_.nodes) {
      if (node.name == text || (number && node.id.value() == *number)) fault.node = node.id;
    }
    if (!fault.node) refuse(mark, text, "a node of the network, by name or number");
  }

  void read_time(Time& time, const std::string& text, const YAML::Mark& mark) {
    const auto parsed = parse_duration(text);
    const bool has_unit = text.find_first_not_of("0123456789.") != std::string::npos;
    if (!parsed || !has_unit) return refuse(mark, text, "a time like 500ms, 2s or 100us");
    time = *parsed;
  }

  void read_probability(sim::Fault& fault, const std::string& text, const YAML::Mark& mark) {
    const auto parsed = parse_real(text);
    if (!parsed || !(*parsed >= 0.0 && *parsed <= 1.0)) return refuse(mark, text, "0 to 1");
    fault.probability = *parsed;
  }

  void read_data(sim::Fault& fault, const std::string& text, const YAML::Mark& mark) {
    unsigned byte = 0;
    for (std::size_t i = 0; i + 1 < text.size() + 1; i += 2) {
      const char* begin = text.data() + i;
      const char* end = text.data() + std::min(i + 2, text.size());
      const auto parsed = std::from_chars(begin, end, byte, 16);
      if (parsed.ec != std::errc{} || parsed.ptr != end || i >= 16) {
        return refuse(mark, text, "up to eight bytes in hex, like 0102FF");
      }
      fault.value.push_back(std::byte(byte));
    }
  }

  void refuse(const YAML::Mark& mark, const std::string& text, const std::string& wanted) {
    error(mark, "fault-value", "`" + text + "` is not " + wanted);
  }

  std::string file_;
  const BusPlan& plan_;
  std::size_t applications_;
  FaultFile result_;
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
