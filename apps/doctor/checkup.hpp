#pragma once
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "master/linux/can_link.hpp"
#include "master/linux/rt_thread.hpp"

namespace takt {

enum class Verdict : std::uint8_t { good, hint, bad };

/// One line of `takt doctor`.
struct Remark {
  Verdict verdict = Verdict::good;
  std::string subject;    ///< "can0", "multicast"
  std::string text;       ///< what was found; where it isn't good, what to do
  std::string command{};  ///< mends it; empty: nothing to mend, or no single command does
};

/// Whether the kernel opens CAN sockets.
Remark check_can_support();

/// The CAN interface `name`: there, up, fit for a cycle. `bitrate`: what it ought to run at; none:
/// whatever it has.
std::vector<Remark> check_interface(const std::string& name, std::optional<std::uint32_t> bitrate);
std::vector<Remark> judge_link(const CanLink& link, std::optional<std::uint32_t> bitrate);

/// Kernel, clock and frequency governor as files below `root` ("/") say.
std::vector<Remark> check_machine(const std::filesystem::path& root);

/// What a thread gets that asks for SCHED_FIFO and locked memory.
std::vector<Remark> judge_realtime(const RtReport& report);

/// Multicast route and socket buffers for LCM at `url`; buffers as files below `root` say.
std::vector<Remark> check_lcm(const std::string& url, const std::filesystem::path& root);

}  // namespace takt
