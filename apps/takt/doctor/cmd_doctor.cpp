#include <CLI/CLI.hpp>
#include <algorithm>
#include <cstdio>
#include <iterator>
#include <nlohmann/json.hpp>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "apps/command_line/bus_option.hpp"
#include "apps/command_line/commands.hpp"
#include "apps/command_line/help_text.hpp"
#include "apps/command_line/json_text.hpp"
#include "apps/command_line/whole_number.hpp"
#include "apps/takt/doctor/checkup.hpp"
#include "apps/takt/live/screen.hpp"
#include "master/lcm/link/lcm_url.hpp"

namespace takt {
namespace doctor {
namespace {

struct DoctorOptions {
  std::string bus;
  std::string lcm_url;
  std::optional<std::uint32_t> bitrate_kbit;
  int priority = 80;
  bool json = false;
};

void append(std::vector<Remark>& all, std::vector<Remark> more) {
  std::ranges::move(more, std::back_inserter(all));
}

/// Tries real time with a separate thread, so that only one effect on this process remains: its
/// memory is locked.
std::vector<Remark> try_realtime(int priority) {
  RealtimeOptions options;
  options.mode = RtMode::attempt;
  options.priority = priority;
  RtReport report;
  std::thread{[&] { report = apply_realtime(options); }}.join();
  return judge_realtime(report);
}

std::vector<Remark> examine(const DoctorOptions& options) {
  std::vector<Remark> all;
  const bool is_can = !options.bus.starts_with("unix:") && options.bus != "sim";
  if (options.bus.empty() || is_can) all.push_back(check_can_support());
  if (!options.bus.empty() && is_can) {
    const auto bitrate = options.bitrate_kbit ? std::optional{*options.bitrate_kbit * 1000}
                                              : std::optional<std::uint32_t>{};
    append(all, check_interface(options.bus, bitrate));
  }
  append(all, check_machine("/"));
  append(all, try_realtime(options.priority));
  append(all, check_lcm(choose_lcm_url(options.lcm_url, ""), "/"));
  return all;
}

const char* word(Verdict verdict) {
  if (verdict == Verdict::good) return "good";
  return verdict == Verdict::hint ? "hint" : "BAD";
}

/// Prints each remark with its text beside its subject, or below it on a narrow terminal. A command
/// is not broken, because users copy it.
void print(const std::vector<Remark>& remarks) {
  static constexpr Paint paints[] = {Paint::good, Paint::warning, Paint::bad};
  constexpr std::size_t beside = 22;
  constexpr std::size_t below = 6;
  constexpr std::size_t narrow = 70;
  const std::size_t width = text_width();
  const std::size_t indent = width < narrow ? below : beside;
  for (const Remark& remark : remarks) {
    std::vector<std::string> texts = broken(remark.text, width - indent);
    Line head;
    head.add(left(word(remark.verdict), below), paints[static_cast<std::size_t>(remark.verdict)])
        .add(indent == beside ? left(remark.subject, beside - below) : remark.subject,
             Paint::title);
    if (indent == beside) {
      head.add(texts.front());
      texts.erase(texts.begin());
    }
    const std::string space(indent, ' ');
    std::vector<Line> lines{std::move(head)};
    for (const std::string& text : texts) lines.push_back(std::move(Line{}.add(space + text)));
    print_lines(lines, width);
    if (!remark.command.empty()) std::puts((space + remark.command).c_str());
  }
}

void print_json(const std::vector<Remark>& remarks) {
  nlohmann::json all = nlohmann::json::array();
  for (const Remark& remark : remarks) {
    all.push_back({{"verdict", remark.verdict == Verdict::bad ? "bad" : word(remark.verdict)},
                   {"subject", remark.subject},
                   {"text", remark.text},
                   {"command", remark.command}});
  }
  const nlohmann::json document{{"remarks", std::move(all)}};
  std::puts(json_text(document, 1).c_str());
}

int run(const DoctorOptions& options) {
  const std::vector<Remark> remarks = examine(options);
  options.json ? print_json(remarks) : print(remarks);
  return std::ranges::any_of(remarks, [](const Remark& r) { return r.verdict == Verdict::bad; })
             ? 1
             : 0;
}

}  // namespace
}  // namespace doctor

void add_doctor(CLI::App& app, int& exit_code) {
  auto [verb, options] = add_command<doctor::DoctorOptions>(
      app, exit_code, "doctor",
      "checks whether this machine is ready for a bus, and shows corrections", doctor::run);
  verb.footer(
      "Each line is good, a hint or BAD (exit code 1). The command below a line corrects the "
      "fault;\n"
      "run that command as root. takt doctor itself changes nothing.\n"
      "Examples:\n"
      "  takt doctor\n"
      "  takt doctor --bus can0 --bitrate 500");
  add_bus(verb, options.bus, "CAN interface: can0, vcan0")->type_name("IFACE");
  add_number(verb, "--bitrate", options.bitrate_kbit,
             "bit rate that the interface must have, kbit/s")
      ->check(CLI::Range(10, 1000))
      ->type_name("KBIT");
  add_number(verb, "--priority", options.priority,
             "SCHED_FIFO priority that takt tries to get (80)")
      ->check(CLI::Range(1, 99))
      ->type_name("N");
  verb.add_option("--lcm-url", options.lcm_url,
                  "LCM URL to check; default: LCM_DEFAULT_URL, else LCM's own")
      ->type_name("URL");
  verb.add_flag("--json", options.json, "print one JSON document");
}

}  // namespace takt
