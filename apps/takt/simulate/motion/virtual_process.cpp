#include "apps/takt/simulate/motion/virtual_process.hpp"

#include <algorithm>
#include <string>
#include <utility>

namespace takt {
namespace {

using namespace std::chrono_literals;

constexpr std::size_t program_room = 300;  // messages
constexpr Time shortest_reaction = 20us;
constexpr Time longest_reaction = 300us;

}  // namespace

class VirtualProcess::Connection final : public Transport {
 public:
  explicit Connection(VirtualProcess& process) : process_{process} {}

  bool publish(const std::string& channel, std::span<const std::byte> data) override {
    return process_.killed_ || process_.lcm_.publish(channel, data);
  }
  void subscribe(const std::string& channel) override {
    if (!process_.killed_) process_.lcm_.subscribe(channel);
  }
  void serve(const MessageHandler& handler) override {
    if (!process_.killed_) process_.lcm_.serve(handler);
  }
  void watch(std::vector<pollfd>&) const override {}
  bool good() const override { return true; }
  std::string url() const override { return process_.lcm_.url(); }

 private:
  VirtualProcess& process_;
};

VirtualProcess::VirtualProcess(VirtualLcm& lcm, const Clocks& clocks, sim::Random random)
    : lcm_{lcm.join(program_room)}, clocks_{clocks}, random_{random} {}

std::unique_ptr<Transport> VirtualProcess::connect() { return std::make_unique<Connection>(*this); }

void VirtualProcess::start(std::function<void()> work) {
  work_ = std::move(work);
  ended_ = killed_ = false;
  after_death_ = {};
  wake_ = clocks_.now();
  thread_ = std::thread{[this] {
    await(Turn::program);
    {
      const UseSurroundings here{*this};
      if (!killed_) work_();
    }
    ended_ = true;
    pass_to(Turn::simulation);
  }};
}

void VirtualProcess::await(Turn turn) {
  std::unique_lock lock{mutex_};
  changed_.wait(lock, [&] { return turn_ == turn; });
}

void VirtualProcess::pass_to(Turn turn) {
  const std::scoped_lock lock{mutex_};
  turn_ = turn;
  changed_.notify_one();
}

void VirtualProcess::kill() {
  if (!thread_.joinable()) return;
  killed_ = true;
  lcm_.close();
  pass_to(Turn::program);
  await(Turn::simulation);
  thread_.join();
}

void VirtualProcess::wait(std::span<pollfd>, std::chrono::nanoseconds longest) {
  if (killed_) {
    after_death_ += longest;
    return;
  }
  wake_ = clocks_.now() + longest;
  pass_to(Turn::simulation);
  await(Turn::program);
}

std::int64_t VirtualProcess::random_number() {
  return static_cast<std::int64_t>(random_.next() >> 2 | 1U);
}

Time VirtualProcess::next() const noexcept {
  if (!thread_.joinable()) return never;
  const Time arrival = lcm_.next_arrival();
  return arrival == never ? wake_ : std::min(wake_, arrival + reaction_);
}

void VirtualProcess::act(Time) {
  reaction_ = shortest_reaction + random_.up_to(longest_reaction);
  pass_to(Turn::program);
  await(Turn::simulation);
  if (ended_) thread_.join();
}

}  // namespace takt
