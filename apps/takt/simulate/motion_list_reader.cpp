#include "apps/takt/simulate/motion_list_reader.hpp"

#include <algorithm>
#include <array>
#include <chrono>
#include <span>
#include <string_view>
#include <utility>

#include "apps/takt/simulate/motion/motion_programs.hpp"
#include "eds_parser/ini/number.hpp"
#include "eds_parser/report/suggest.hpp"

namespace takt {
namespace {

using Keys = std::span<const std::string_view>;

constexpr std::string_view unnamed_program = "program";
constexpr std::array<std::string_view, 5> common_keys{"kind", "at", "program", "axes", "expect"};
constexpr std::array<std::string_view, 4> bound_keys{"velocity", "acceleration", "jerk",
                                                     "following_error"};
constexpr std::array<std::string_view, 1> move_keys{"to"};
constexpr std::array<std::string_view, 1> move_by_keys{"by"};
constexpr std::array<std::string_view, 1> stream_keys{"points"};
constexpr std::array<std::string_view, 7> gear_keys{
    "leader", "signal", "ratio", "phase", "modulo", "filter_time", "max_phase_error"};

/// Returns the keys of a kind besides the common ones and the bounds. The first is required.
Keys own_keys(MotionKind kind) noexcept {
  using enum MotionKind;
  if (kind == move) return move_keys;
  if (kind == move_by) return move_by_keys;
  if (kind == stream) return stream_keys;
  if (kind == gear) return gear_keys;
  if (kind == jog) return Keys{bound_keys}.first(1);
  return {};
}

bool contains(Keys known, std::string_view key) {
  return std::ranges::find(known, key) != known.end();
}

std::vector<std::string_view> keys_of(MotionKind kind, bool of_speed) {
  std::vector<std::string_view> all{common_keys.begin(), common_keys.end()};
  const Keys own = own_keys(kind);
  all.insert(all.end(), own.begin(), own.end());
  const Keys bounds = of_speed ? Keys{bound_keys}.first(2) : Keys{bound_keys};
  if (goes_on(kind)) all.insert(all.end(), bounds.begin(), bounds.end());
  return all;
}

std::optional<MotionKind> kind_of(std::string_view text) {
  const auto found = std::ranges::find(motion_kind_names, text);
  if (found == motion_kind_names.end()) return std::nullopt;
  return static_cast<MotionKind>(found - motion_kind_names.begin());
}

std::string joined(const std::vector<std::string>& names) {
  std::string text;
  for (const std::string& name : names) text += (text.empty() ? "" : ", ") + name;
  return text.empty() ? "none" : text;
}

}  // namespace

MotionListReader::MotionListReader(EntryReader& reader, const BusPlan& plan)
    : reader_{reader},
      with_positions_{motion_axis_names(plan)},
      with_speeds_{speed_axis_names(plan)},
      known_{with_positions_} {
  known_.insert(known_.end(), with_speeds_.begin(), with_speeds_.end());
}

void MotionListReader::read(const YAML::Node& list) {
  for (const YAML::Node& entry : list) read_entry(entry);
}

void MotionListReader::read_entry(const YAML::Node& entry) {
  if (!entry.IsMap() || !entry["kind"]) {
    return reader_.error(entry.Mark(), "motion-kind", "a motion is a map with at least `kind:`");
  }
  const YAML::Node named = entry["kind"];
  const auto kind = kind_of(named.as<std::string>(""));
  if (!kind) {
    const auto text = named.as<std::string>("");
    return reader_.error(named.Mark(), "motion-kind",
                         "unknown kind `" + text + "`" + did_you_mean(text, motion_kind_names));
  }
  MotionScript* script = program_of(entry);
  if (script == nullptr) return;
  if (is_speed_axis(script->axes.front()) && needs_position(*kind)) {
    return reader_.error(named.Mark(), "motion-kind",
                         "`" + std::string{name(*kind)} + "` needs a position, and `" +
                             script->axes.front() + "` is a speed axis: use `jog` and `stop`");
  }
  MotionEntry motion{.kind = *kind, .pos = place_of(entry.Mark())};
  for (const auto& pair : entry) read_key(motion, EntryItem{pair}, *script);
  const Keys own = own_keys(*kind);
  if (!own.empty() && !entry[std::string{own.front()}]) {
    reader_.error(entry.Mark(), "motion-value",
                  "`" + std::string{own.front()} + "` is missing: `" + std::string{name(*kind)} +
                      "` needs it");
  }
  check_time(entry, motion, *script);
  script->entries.push_back(std::move(motion));
}

/// The first entry of a program names its axes. Without names, the program has all axes.
MotionScript* MotionListReader::program_of(const YAML::Node& entry) {
  const YAML::Node named = entry["program"];
  const auto program = named ? named.as<std::string>("") : std::string{unnamed_program};
  if (program.empty()) {
    reader_.error(named.Mark(), "motion-value", "`program` needs a name");
    return nullptr;
  }
  const YAML::Node list = entry["axes"];
  const std::vector<std::string>& all = with_positions_.empty() ? with_speeds_ : with_positions_;
  std::vector<std::string> axes = list ? read_axes(list) : all;
  const auto known = std::ranges::find(scripts_, program, &MotionScript::program);
  if (known == scripts_.end()) {
    if (axes.empty()) {
      if (!list) reader_.error(entry.Mark(), "motion-axes", "taktd can move no axis of this bus");
      return nullptr;
    }
    return &scripts_.emplace_back(MotionScript{.program = program, .axes = std::move(axes)});
  }
  if (list && axes != known->axes) {
    reader_.error(list.Mark(), "motion-axes",
                  "program `" + program + "` commands the axes " + joined(known->axes) +
                      ", as its first entry says: leave out `axes`, or name another `program`");
  }
  return &*known;
}

std::vector<std::string> MotionListReader::read_axes(const YAML::Node& list) {
  std::vector<std::string> axes;
  if (!list.IsSequence() || list.size() == 0) {
    reader_.error(list.Mark(), "motion-axes", "`axes` is not a list of axes: " + joined(known_));
    return axes;
  }
  for (const YAML::Node& one : list) {
    auto axis = one.as<std::string>("");
    if (std::ranges::find(known_, axis) == known_.end()) {
      reader_.error(one.Mark(), "motion-axes",
                    "`" + axis + "` is no axis that taktd can move: " + joined(known_));
    } else if (std::ranges::find(axes, axis) != axes.end()) {
      reader_.error(one.Mark(), "motion-axes", "`" + axis + "` is named twice");
    } else if (!axes.empty() && is_speed_axis(axis) != is_speed_axis(axes.front())) {
      reader_.error(one.Mark(), "motion-axes",
                    "`" + axis + "` and `" + axes.front() +
                        "` are of two kinds: a program commands either axes with positions or "
                        "speed axes");
    } else {
      axes.push_back(std::move(axis));
    }
  }
  return axes;
}

bool MotionListReader::is_speed_axis(const std::string& axis) const {
  return std::ranges::find(with_speeds_, axis) != with_speeds_.end();
}

/// A program executes its entries in their order.
void MotionListReader::check_time(const YAML::Node& entry, const MotionEntry& motion,
                                  const MotionScript& script) {
  if (!motion.at) {
    const bool waits = !script.entries.empty() && is_endless(script.entries.back().kind);
    if (!waits && motion.kind != MotionKind::kill) return;
    return reader_.error(entry.Mark(), "motion-time",
                         waits ? "`at` is missing: the `" +
                                     std::string{name(script.entries.back().kind)} +
                                     "` before does not end by itself"
                               : "`at` is missing: `kill` needs a time");
  }
  for (const MotionEntry& other : script.entries) {
    if (!other.at || *other.at <= *motion.at) continue;
    return reader_.error(entry.Mark(), "motion-time",
                         "`at` is earlier than that of line " + std::to_string(other.pos.line) +
                             ": a program executes its entries in their order");
  }
}

void MotionListReader::read_key(MotionEntry& motion, const EntryItem& item,
                                const MotionScript& script) {
  const std::size_t axes = script.axes.size();
  const bool of_speed = is_speed_axis(script.axes.front());
  const std::string& key = item.key;
  if (contains(common_keys, key)) {
    if (key == "expect") return read_expectation(motion, item);
    if (key != "at") return;
    motion.at.emplace();
    return reader_.read_time(*motion.at, item);
  }
  const std::vector<std::string_view> possible = keys_of(motion.kind, of_speed);
  if (!contains(possible, key)) {
    return reader_.error(item.key_mark, "unknown-key",
                         "`" + key + "` has no meaning for `" + std::string{name(motion.kind)} +
                             (of_speed ? "` of a speed axis" : "`") + did_you_mean(key, possible));
  }
  if (key == "to" || key == "by" || (key == "velocity" && motion.kind == MotionKind::jog)) {
    motion.values = read_each(item, axes);
    if (key == "velocity") motion.bounds.velocity = motion.values.cwiseAbs();
  } else if (key == "velocity") {
    motion.bounds.velocity = read_numbers(item, axes);
  } else if (key == "acceleration") {
    motion.bounds.acceleration = read_numbers(item, axes);
  } else if (key == "jerk") {
    motion.bounds.jerk = read_numbers(item, axes);
  } else if (key == "following_error") {
    motion.bounds.following_error = read_numbers(item, axes);
  } else if (key == "points") {
    read_points(motion, item, axes);
  } else {
    read_gear(motion.gear, item, axes);
  }
}

void MotionListReader::read_expectation(MotionEntry& motion, const EntryItem& item) {
  if (!contains(expectable_ends, item.text)) {
    return reader_.error(
        item.mark, "motion-value",
        "`" + item.text + "` is not an end of a motion" + did_you_mean(item.text, expectable_ends));
  }
  motion.expect = item.text;
}

void MotionListReader::read_gear(Gear& gear, const EntryItem& item, std::size_t axes) {
  const std::string& key = item.key;
  if (key == "leader" || key == "signal") {
    if (item.text.empty()) reader_.refuse(item, "a name");
    (key == "leader" ? gear.leader : gear.signal) = item.text;
  } else if (key == "ratio") {
    gear.ratio = read_numbers(item, axes);
  } else if (key == "phase") {
    gear.phase = read_numbers(item, axes);
  } else if (key == "max_phase_error") {
    gear.max_phase_error = read_numbers(item, axes);
  } else if (key == "filter_time") {
    Time time{};
    reader_.read_time(time, item);
    gear.filter_time = time;
  } else {
    const auto number = parse_real(item.text);
    if (!number) return reader_.refuse(item, "a number");
    gear.modulo = *number;
  }
}

Eigen::VectorXd MotionListReader::read_numbers(const EntryItem& item, std::size_t axes) {
  std::vector<std::string> texts;
  if (item.is_scalar) texts.push_back(item.text);
  if (item.value.IsSequence()) {
    for (const YAML::Node& one : item.value) texts.push_back(one.as<std::string>(""));
  }
  Eigen::VectorXd numbers(static_cast<Eigen::Index>(texts.size()));
  bool good = texts.size() == 1 || texts.size() == axes;
  for (std::size_t i = 0; i < texts.size(); ++i) {
    const auto number = parse_real(texts[i]);
    good = good && number;
    numbers(static_cast<Eigen::Index>(i)) = number.value_or(0.0);
  }
  if (!good) {
    reader_.refuse(item, axes == 1 ? "a number"
                                   : "a number, or a list of " + std::to_string(axes) +
                                         " numbers, one for each axis");
    numbers = Eigen::VectorXd::Zero(1);
  }
  return numbers;
}

Eigen::VectorXd MotionListReader::read_each(const EntryItem& item, std::size_t axes) {
  const Eigen::VectorXd numbers = read_numbers(item, axes);
  if (numbers.size() != 1) return numbers;
  return Eigen::VectorXd::Constant(static_cast<Eigen::Index>(axes), numbers(0));
}

void MotionListReader::read_points(MotionEntry& motion, const EntryItem& item, std::size_t axes) {
  if (!item.value.IsSequence() || item.value.size() == 0) {
    return reader_.refuse(item, "a list of points: {time, position, velocity}");
  }
  for (const YAML::Node& point : item.value) {
    if (!point.IsMap() || !point["time"] || !point["position"] || !point["velocity"]) {
      reader_.error(point.Mark(), "motion-value",
                    "a point is a map with `time`, `position` and `velocity`");
      continue;
    }
    PathPoint& read = motion.points.emplace_back();
    for (const auto& pair : point) read_point(read, EntryItem{pair}, axes);
  }
}

void MotionListReader::read_point(PathPoint& point, const EntryItem& item, std::size_t axes) {
  constexpr std::array<std::string_view, 4> possible{"time", "position", "velocity",
                                                     "acceleration"};
  if (item.key == "time") {
    Time time{};
    reader_.read_time(time, item);
    point.time = std::chrono::duration<double>(time).count();
  } else if (item.key == "position") {
    point.position = read_each(item, axes);
  } else if (item.key == "velocity") {
    point.velocity = read_each(item, axes);
  } else if (item.key == "acceleration") {
    point.acceleration = read_each(item, axes);
  } else {
    reader_.error(
        item.key_mark, "unknown-key",
        "`" + item.key + "` has no meaning for a point" + did_you_mean(item.key, possible));
  }
}

}  // namespace takt
