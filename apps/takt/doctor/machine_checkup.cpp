#include <fstream>
#include <string_view>
#include <sys/utsname.h>

#include "apps/takt/doctor/checkup.hpp"

namespace takt::doctor {
namespace {

namespace fs = std::filesystem;

/// Returns the first line of a file of the kernel. Empty if the file does not exist.
std::string line_of(const fs::path& path) {
  std::ifstream file{path};
  std::string line;
  std::getline(file, line);
  return line;
}

Remark check_kernel(const fs::path& root) {
  utsname name{};
  ::uname(&name);
  const bool realtime = line_of(root / "sys/kernel/realtime") == "1" ||
                        std::string_view{name.version}.find("PREEMPT_RT") != std::string_view::npos;
  if (realtime) return {Verdict::good, "kernel", std::string{name.release} + " with PREEMPT_RT"};
  return {
      Verdict::hint, "kernel",
      std::string{name.release} + " without PREEMPT_RT: SYNC may be late by some 100 us under load",
      "apt install linux-image-rt-amd64"};
}

Remark check_clock(const fs::path& root) {
  const std::string clock =
      line_of(root / "sys/devices/system/clocksource/clocksource0/current_clocksource");
  if (clock == "hpet" || clock == "acpi_pm" || clock == "jiffies") {
    return {Verdict::hint, "clock",
            clock +
                " is slow to read; if the processor has a steady TSC, put `clocksource=tsc` on the "
                "kernel's command line"};
  }
  return {Verdict::good, "clock", clock.empty() ? "unknown" : clock};
}

Remark check_governor(const fs::path& root) {
  const std::string governor =
      line_of(root / "sys/devices/system/cpu/cpu0/cpufreq/scaling_governor");
  if (governor.empty()) return {Verdict::good, "CPU frequency", "the kernel does not change it"};
  if (governor == "performance") return {Verdict::good, "CPU frequency", governor};
  return {Verdict::hint, "CPU frequency", "governor '" + governor + "' makes wake-ups late",
          "cpupower frequency-set -g performance"};
}

}  // namespace

std::vector<Remark> check_machine(const fs::path& root) {
  return {check_kernel(root), check_clock(root), check_governor(root)};
}

std::vector<Remark> judge_realtime(const RtReport& report) {
  std::vector<Remark> remarks;
  for (const std::string& missing : report.missing) {
    remarks.push_back({Verdict::bad, "real time", missing});
  }
  if (!remarks.empty()) return remarks;
  return {{Verdict::good, "real time",
           "SCHED_FIFO " + std::to_string(report.priority) + " and locked memory are granted"}};
}

}  // namespace takt::doctor
