#include "apps/takt/smooth/smooth_report.hpp"

#include <algorithm>
#include <fmt/format.h>

#include "apps/takt/smooth/judge/numbers.hpp"

namespace takt::smooth {
namespace {

using Json = nlohmann::ordered_json;

const char* word_of(Gravity gravity) { return gravity == Gravity::error ? "error" : "warning"; }

/// Breaks a text into lines of at most 100 characters, all of them indented.
std::string wrapped(const std::string& text, const std::string& indent) {
  constexpr std::size_t width = 100;
  std::string out;
  std::string line = indent;
  for (std::size_t from = 0; from < text.size();) {
    const std::size_t to = std::min(text.find(' ', from), text.size());
    const std::string word = text.substr(from, to - from);
    if (line.size() > indent.size() && line.size() + 1 + word.size() > width) {
      out += line + '\n';
      line = indent;
    }
    line += (line.size() > indent.size() ? " " : "") + word;
    from = to + 1;
  }
  return out + line + '\n';
}

std::string findings_text(const std::string& of, const std::vector<Finding>& findings) {
  std::string out;
  for (const Finding& finding : findings) {
    out += fmt::format("\n{}: {} [{}]\n", of, word_of(finding.gravity), name_of(finding.cause));
    out += wrapped(finding.text, "  ");
    out += wrapped("Remedy: " + finding.remedy, "  ");
  }
  return out;
}

std::string summary(const Verdict& verdict) {
  std::size_t rough = 0;
  std::size_t doubtful = 0;
  std::size_t still = 0;
  for (const AxisVerdict& axis : verdict.axes) {
    const bool error = std::ranges::any_of(
        axis.findings, [](const Finding& f) { return f.gravity == Gravity::error; });
    if (axis.moving == 0) {
      ++still;
    } else if (error) {
      ++rough;
    } else if (!axis.findings.empty()) {
      ++doubtful;
    }
  }
  const std::size_t smooth = verdict.axes.size() - rough - doubtful - still;
  return fmt::format("{} rough, {} with a warning, {} smooth, {} without motion in a cyclic mode{}",
                     rough, doubtful, smooth, still,
                     verdict.findings.empty() ? "" : "; SYNC has findings");
}

std::string sync_text(const Verdict& verdict) {
  if (verdict.sync.period == Time{}) return "There is no SYNC.\n";
  return fmt::format(
      "SYNC every {:.4f} ms, 95 of 100 intervals within {:.3f} ms, worst {:.3f} ms\n",
      ms(verdict.sync.period), ms(verdict.sync.jitter), ms(verdict.sync.largest_deviation));
}

Json json_of(const std::vector<Finding>& findings) {
  Json list = Json::array();
  for (const Finding& finding : findings) {
    list.push_back({{"cause", name_of(finding.cause)},
                    {"severity", word_of(finding.gravity)},
                    {"text", finding.text},
                    {"remedy", finding.remedy},
                    {"count", finding.count},
                    {"first_s", seconds(finding.first)}});
  }
  return list;
}

double us(Time time) { return 1e-3 * static_cast<double>(time.count()); }

Json json_of(const AxisVerdict& axis) {
  Json json{{"name", axis.name},
            {"node_id", axis.node},
            {"axis", axis.axis + 1},
            {"index", axis.set_point.index},
            {"sub", axis.set_point.sub},
            {"cob_id", axis.set_point_id.id()},
            {"set_points", axis.set_points},
            {"cycles", axis.cycles},
            {"moving", axis.moving},
            {"without", axis.without},
            {"with_two", axis.with_two},
            {"period_us", us(axis.period)}};
  json["interpolation_us"] =
      axis.interpolation == Time{} ? Json(nullptr) : Json(us(axis.interpolation));
  json["peak_velocity"] = axis.peak_velocity;
  json["findings"] = json_of(axis.findings);
  return json;
}

}  // namespace

std::string verdict_text(const Verdict& verdict) {
  std::string out =
      fmt::format("{}, {:.3f} s: {}\n", verdict.source, seconds(verdict.length), summary(verdict));
  out += sync_text(verdict);
  for (const std::string& remark : verdict.remarks) out += wrapped(remark, "");
  out += fmt::format("\n{:<16} {:>9} {:>10} {:>9} {:>8} {:>8} {:>11} {:>9} {:>14}\n", "AXIS",
                     "SET-POINT", "EVERY ms", "60C2 ms", "CYCLES", "MOVING", "WITHOUT ONE",
                     "WITH TWO", "INCREMENTS/s");
  for (const AxisVerdict& axis : verdict.axes) {
    const std::string interpolation =
        axis.interpolation == Time{} ? "-" : fmt::format("{:.3f}", ms(axis.interpolation));
    out += fmt::format("{:<16} {:>9} {:>10.4f} {:>9} {:>8} {:>8} {:>11} {:>9} {:>14.0f}\n",
                       axis.name, to_string(axis.set_point), ms(axis.period), interpolation,
                       axis.cycles, axis.moving, axis.without, axis.with_two, axis.peak_velocity);
  }
  out += findings_text("SYNC", verdict.findings);
  for (const AxisVerdict& axis : verdict.axes) out += findings_text(axis.name, axis.findings);
  return out;
}

nlohmann::ordered_json verdict_json(const Verdict& verdict) {
  Json json{{"source", verdict.source},
            {"length_s", seconds(verdict.length)},
            {"rough", verdict.rough()}};
  json["sync"] = Json{{"period_us", us(verdict.sync.period)},
                      {"jitter_us", us(verdict.sync.jitter)},
                      {"worst_us", us(verdict.sync.largest_deviation)},
                      {"missing", verdict.sync.missing},
                      {"surplus", verdict.sync.surplus}};
  json["sync"]["findings"] = json_of(verdict.findings);
  json["axes"] = Json::array();
  for (const AxisVerdict& axis : verdict.axes) json["axes"].push_back(json_of(axis));
  json["remarks"] = verdict.remarks;
  return json;
}

}  // namespace takt::smooth
