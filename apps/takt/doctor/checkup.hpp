#pragma once
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "master/linux/can/can_link.hpp"
#include "master/linux/rt_thread.hpp"

namespace takt::doctor {

enum class Verdict : std::uint8_t { good, hint, bad };

/// One line of `takt doctor`.
struct Remark {
  Verdict verdict = Verdict::good;
  std::string subject;    ///< "can0", "multicast"
  std::string text;       ///< the finding, and advice if the verdict is not good
  std::string command{};  ///< command that repairs it; empty if no single command does
};

/// Checks that the kernel opens CAN sockets.
Remark check_can_support();

/// Checks that the CAN interface `name` exists, is up and suits a cycle. `bitrate` is the bit rate
/// that the interface should have, in bit/s; std::nullopt accepts any.
std::vector<Remark> check_interface(const std::string& name, std::optional<std::uint32_t> bitrate);
/// Judges an interface whose properties were already read. See check_interface().
std::vector<Remark> judge_link(const CanLink& link, std::optional<std::uint32_t> bitrate);

/// Checks kernel, clock and frequency governor. Reads the files of the kernel below `root` ("/").
std::vector<Remark> check_machine(const std::filesystem::path& root);

/// Judges the result of a thread that has requested SCHED_FIFO and locked memory.
std::vector<Remark> judge_realtime(const RtReport& report);

/// Checks multicast route and socket buffers for LCM at `url`. Reads the size of the buffers below
/// `root`.
std::vector<Remark> check_lcm(const std::string& url, const std::filesystem::path& root);

}  // namespace takt::doctor
