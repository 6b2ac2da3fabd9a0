#include "test/unit/apps/takt/smooth/judge/generated_trace.hpp"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <numbers>
#include <stdexcept>

#include "apps/takt/smooth/make_record.hpp"
#include "apps/takt/smooth/pdo_map.hpp"
#include "apps/takt/smooth/smooth_report.hpp"
#include "apps/takt/smooth/trace.hpp"

namespace takt::smooth {
namespace {

using std::chrono::microseconds;
using std::chrono::milliseconds;

constexpr std::size_t motions = 4;

/// Position on the way from 0 to 1 with zero velocity and acceleration at both ends.
double minimum_jerk(double s) {
  s = std::clamp(s, 0.0, 1.0);
  return s * s * s * (10 + s * (-15 + 6 * s));
}

Time motion_time(const Recipe& recipe) {
  return std::max<Time>(milliseconds{500}, recipe.period * 150);
}

/// Motions there and back with a rest before each of them.
std::function<double(Time)> there_and_back(const Recipe& recipe, double distance, double start) {
  const Time motion = motion_time(recipe);
  const Time rest = std::max<Time>(motion / 5, recipe.period * 20);
  return [=](Time t) {
    const Time turn = motion + rest;
    const auto number = t < Time{} ? 0 : t / turn;
    const double s = static_cast<double>((t - number * turn - rest).count()) /
                     static_cast<double>(motion.count());
    const double way = minimum_jerk(s);
    return start + distance * (number % 2 == 0 ? way : 1 - way);
  };
}

std::string hex_bytes(std::uint64_t value, unsigned bytes) {
  std::string text;
  for (unsigned i = 0; i < bytes; ++i) text += fmt::format("{:02X}", value >> (8 * i) & 0xFFU);
  return text;
}

/// The boot of a drive as candump shows it.
class BootText {
 public:
  explicit BootText(unsigned node) : node_{node} { line(0x700 + node, "00"); }

  void write(unsigned index, unsigned sub, unsigned bytes, std::uint64_t value) {
    const char* command = bytes == 1 ? "2F" : bytes == 2 ? "2B" : "23";
    const std::string object = hex_bytes(index, 2) + hex_bytes(sub, 1);
    line(0x600 + node_, command + object + hex_bytes(value, 4));
    line(0x580 + node_, "60" + object + "00000000");
  }

  void pdo(unsigned communication, std::uint64_t id, unsigned type,
           const std::vector<std::uint64_t>& mapping) {
    write(communication, 1, 4, id | 0x8000'0000U);
    write(communication + 0x200, 0, 1, 0);
    unsigned sub = 0;
    for (const std::uint64_t entry : mapping) write(communication + 0x200, ++sub, 4, entry);
    write(communication + 0x200, 0, 1, mapping.size());
    write(communication, 2, 1, type);
    write(communication, 1, 4, id);
  }

  void start() { line(0, fmt::format("01{:02X}", node_)); }

  std::vector<std::string> lines;

 private:
  void line(unsigned id, const std::string& data) {
    lines.push_back(fmt::format("({:.6f}) can0 {:03X}#{}", 1000.0, id, data));
  }

  unsigned node_;
};

std::vector<std::string> boot_of(unsigned node, const Recipe& recipe) {
  BootText boot{node};
  boot.pdo(0x1400, 0x200 + node, recipe.transmission, {0x6040'0010, 0x607A'0020});
  boot.pdo(0x1800, 0x180 + node, 1, {0x6041'0010, 0x6064'0020});
  boot.pdo(0x1801, 0x280 + node, 1, {0x606C'0020, 0x6061'0008});
  if (recipe.interpolation != 0) {
    const auto us = static_cast<std::uint64_t>(
        std::lround(recipe.interpolation * 1e-3 * static_cast<double>(recipe.period.count())));
    const bool whole = us % 1000 == 0;
    boot.write(0x60C2, 1, 1, whole ? us / 1000 : us / 100);
    boot.write(0x60C2, 2, 1, whole ? 0xFD : 0xFC);
  }
  boot.write(0x6060, 0, 1, 8);
  boot.start();
  return boot.lines;
}

/// Makes frames in the order of time.
class FrameMaker {
 public:
  explicit FrameMaker(Generated plan) : plan_{std::move(plan)} {}

  std::vector<StampedFrame> frames() {
    for (const Time sync : plan_.syncs) add(sync, {.id = CobId::base(0x80)});
    for (const Sample& other : plan_.others)
      add(other.when, {.id = CobId::base(0x7F0), .length = 8});
    for (std::size_t i = 0; i < plan_.axes.size(); ++i) add_axis(i);
    std::ranges::stable_sort(frames_, {}, &StampedFrame::when);
    return std::move(frames_);
  }

 private:
  void add(Time when, Frame frame) {
    const auto rounded = std::chrono::duration_cast<microseconds>(when + milliseconds{500});
    frames_.push_back({frame, rounded});
  }

  static void put(Frame& frame, unsigned at, std::uint64_t value, unsigned bytes) {
    for (unsigned i = 0; i < bytes; ++i) {
      frame.data[at + i] = static_cast<std::uint8_t>(value >> (8 * i) & 0xFFU);
    }
    frame.length = static_cast<std::uint8_t>(std::max<unsigned>(frame.length, at + bytes));
  }

  static std::uint64_t raw(double value) {
    return static_cast<std::uint64_t>(std::llround(value)) & 0xFFFF'FFFFU;
  }

  void add_axis(std::size_t number) {
    GeneratedAxis& axis = plan_.axes[number];
    const auto node = static_cast<unsigned>(number + 1);
    std::ranges::stable_sort(axis.sent, {}, &Sent::when);
    for (const Sent& sent : axis.sent) {
      Frame frame{.id = CobId::base(0x200 + node)};
      put(frame, 0, 0x000F, 2);
      put(frame, 2, raw(sent.value), 4);
      add(sent.when, frame);
    }
    // The drive takes the newest set-point at SYNC, and follows it with its delay. It answers SYNC.
    const double part = 1 - std::exp(-1 / std::max(0.01, plan_.recipe.delay_cycles));
    double target = axis.sent.empty() ? 0 : axis.sent.front().value;
    double actual = target;
    double last_shown = target;
    std::size_t next = 0;
    for (std::size_t k = 0; k < axis.status.size(); ++k) {
      const Time sync = plan_.planned(k);
      const Time answer = sync + microseconds{120} + microseconds{110} * number;
      const double before = last_shown;
      actual += part * (target - actual);
      while (next < axis.sent.size() && axis.sent[next].when < sync)
        target = axis.sent[next++].value;
      const double shown = actual + (axis.shake ? axis.shake(sync) : 0.0);
      last_shown = shown;
      Frame first{.id = CobId::base(0x180 + node)};
      put(first, 0, axis.status[k], 2);
      put(first, 2, raw(shown), 4);
      add(answer, first);
      Frame second{.id = CobId::base(0x280 + node)};
      put(second, 0, raw((shown - before) / seconds(plan_.recipe.period)), 4);
      put(second, 4, static_cast<std::uint8_t>(axis.mode[k]), 1);
      add(answer + microseconds{55}, second);
    }
  }

  static double seconds(Time time) { return 1e-9 * static_cast<double>(time.count()); }

  Generated plan_;
  std::vector<StampedFrame> frames_;
};

}  // namespace

Time Generated::planned(std::size_t k) const { return recipe.period * static_cast<int>(k); }

bool Generated::chance(double probability) {
  return std::uniform_real_distribution{0.0, 1.0}(random) < probability;
}

double Generated::normal(double deviation) {
  return std::normal_distribution{0.0, 1.0}(random)*deviation;
}

Generated generated(const Recipe& recipe) {
  Generated plan{recipe, std::mt19937{recipe.seed}, {}, {}, {}};
  const Time turn = motion_time(recipe) * 6 / 5 + recipe.period * 25;
  const auto cycles = static_cast<std::size_t>(turn * motions / recipe.period);
  const auto period = static_cast<double>(recipe.period.count());
  const auto moved = [&](double share) {
    const double limit = std::clamp(plan.normal(share), -3 * share, 3 * share);
    return Time{static_cast<std::int64_t>(limit * period)};
  };
  for (std::size_t k = 0; k < cycles; ++k) {
    plan.syncs.push_back(plan.planned(k) + moved(recipe.sync_noise));
  }
  std::uniform_real_distribution<double> distances{60'000, 900'000};
  for (unsigned i = 0; i < recipe.axes; ++i) {
    GeneratedAxis axis;
    const double sign = plan.chance(0.5) ? 1 : -1;
    axis.path = there_and_back(recipe, sign * recipe.size * distances(plan.random),
                               static_cast<double>(plan.random() % 20'000));
    axis.status.assign(cycles, 0x1637);
    axis.mode.assign(cycles, 8);
    for (std::size_t k = 0; k < cycles; ++k) {
      const Time after = Time{static_cast<std::int64_t>(recipe.phase * period)};
      axis.sent.push_back({plan.planned(k) + after + moved(recipe.noise) + microseconds{60} * i,
                           axis.path(plan.planned(k + 1))});
    }
    plan.axes.push_back(std::move(axis));
  }
  return plan;
}

Verdict verdict_of(const Recipe& recipe, const Defect& defect) {
  Generated plan = generated(recipe);
  if (defect) defect(plan);
  TraceBuilder builder{"generated.log", ""};
  PdoMap map;
  for (unsigned node = 1; node <= recipe.axes; ++node) {
    if (!recipe.boot) break;
    for (const std::string& line : boot_of(node, recipe)) builder.add(line);
  }
  Trace trace = builder.take();
  trace.frames = FrameMaker{std::move(plan)}.frames();
  Time newest{-1};
  for (StampedFrame& frame : trace.frames)
    frame.when = newest = std::max(frame.when, newest + Time{1});
  trace.with_times = true;
  trace.resolution = microseconds{1};
  add_learned(map, trace.bus, {});
  map.bitrate = recipe.bitrate;
  for (unsigned node = 1; node <= recipe.axes; ++node) {
    if (recipe.boot) break;
    for (const std::string& pdo :
         {fmt::format("{:X}=6040,607A", 0x200 + node),
          fmt::format("{:X}=6041{}", 0x180 + node, recipe.position_shown ? ",6064" : ""),
          fmt::format("{:X}=606C,6061", 0x280 + node)}) {
      if (const auto added = add_pdo(map, pdo); !added) throw std::runtime_error{added.error()};
    }
  }
  return judge(make_record(trace, map));
}

std::string findings_text(const Verdict& verdict) { return verdict_text(verdict); }

}  // namespace takt::smooth
