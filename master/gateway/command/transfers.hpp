#pragma once
#include <cstdint>
#include <expected>
#include <functional>
#include <span>
#include <string>
#include <takt/transfer_state_t.hpp>
#include <takt/transfer_t.hpp>
#include <vector>

#include "eds_parser/table/bus_plan.hpp"
#include "master/core/request.hpp"
#include "master/gateway/command/requests.hpp"
#include "master/lcm/front_budget.hpp"

namespace takt {

/// Moves files to and from domains: collects a transfer_t in parts, makes one long Request of it
/// and reports its progress by transfer_state_t. A buffer belongs to the bus thread only while its
/// request is under way. All calls come from the front thread.
class Transfers {
 public:
  static constexpr std::size_t part_bytes = 1024;       ///< bytes in one message
  static constexpr std::size_t most_bytes = 16U << 20;  ///< bytes of one file
  static constexpr std::size_t parts_at_once = 16;      ///< largest number of answers to one "more"

  struct Sinks {
    /// Hands a request to the bus thread; returns false if it has no room.
    std::function<bool(const Request&)> submit;
    /// Sends the state to the program that asked.
    std::function<void(const transfer_state_t&)> state;
  };
  /// `buffers` have to outlive every request.
  Transfers(const BusPlan& plan, RequestsOptions options, std::span<SdoTransfer> buffers,
            Sinks sinks);

  void take(const transfer_t& message, Time now);
  /// Answers a message that has waited for too long and does nothing else. The answer gives the
  /// reason, or the progress of a known transfer.
  void take_old(const transfer_t& message, const std::string& why);
  /// Returns false if the reply belongs to a request from elsewhere.
  bool finish(const Reply& reply);
  /// Reports progress, ends transfers whose sender is gone, and then does one step of each transfer
  /// in turn until the budget ends. Returns true if steps may be left over.
  bool on_time(Time now, const FrontBudget& budget);

 private:
  enum class Stage : std::uint8_t { free, filling, running, done, failed };
  struct Job {
    SdoTransfer* buffer = nullptr;
    Stage stage = Stage::free;
    bool submitted = false;
    std::string sender{};
    std::int64_t id = 0;
    Request request;
    std::size_t total = 0;  // number of bytes that the sender announced or requested
    std::size_t received = 0;
    std::size_t part_begin = 0;  // bytes of the file that the sender waits for
    std::size_t part_end = 0;
    std::uint32_t abort_code = 0;
    std::string text{};
    Time heard{};     // time of the last message of the sender
    Time reported{};  // time of the last report of progress
  };

  Job* find(const transfer_t& message);
  std::expected<Request, std::string> translate(const transfer_t& message) const;
  void begin(const transfer_t& message, Time now);
  void fill(Job& job, const transfer_t& message);
  void ask_for_parts(Job& job, const transfer_t& message);
  void send_part(Job& job);
  void watch(Job& job, Time now);
  bool step(Job& job);
  void submit(Job& job);
  void forget(Job& job);
  void cancel(Job& job, const std::string& why);
  void refuse(const transfer_t& message, std::string why);
  transfer_state_t state_of(const Job& job) const;
  transfer_state_t state_for(const std::string& sender, std::int64_t id) const;

  const BusPlan& plan_;
  RequestsOptions options_;
  Sinks sinks_;
  std::vector<Job> jobs_;
  std::size_t turn_ = 0;  // index of the job that has the next step
  std::uint64_t next_id_ = 1;
};

}  // namespace takt
