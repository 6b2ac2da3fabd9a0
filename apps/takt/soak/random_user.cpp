#include "apps/takt/soak/random_user.hpp"

#include <algorithm>
#include <array>

namespace takt::soak {

using namespace std::chrono_literals;

RandomUser::RandomUser(const BusPlan& plan, Exchange& exchange, OutputJudge& judge,
                       Verdict& verdict, sim::Random random)
    : plan_{plan},
      exchange_{exchange},
      judge_{judge},
      verdict_{verdict},
      random_{random},
      motion_{plan} {}

void RandomUser::command(SignalIndex signal, std::int64_t value, Time now) {
  exchange_.set_points.set(signal - plan_.layout.inputs, value, time_to_live_);
  judge_.commanded(signal, value, time_to_live_, now);
}

void RandomUser::on_image(const ImageView& image, Time now) {
  if (silent_ == 0 && random_.chance(0.004)) silent_ = 1 + random_.below(60);
  if (silent_ != 0) {
    if (--silent_ == 0) time_to_live_ = 2 + random_.below(20);
    return;
  }
  for (const SineMotion::Value& next : motion_.next(image)) {
    const Signal& signal = plan_.layout.signals[next.signal];
    const bool free = !plan_.nodes[signal.node_index].cia402 && signal.bits > 1 && signal.bits < 63;
    command(next.signal, free ? any_value(next.signal, image.cycle) : next.value, now);
  }
  exchange_.set_points.publish(now);
}

/// Returns a value that changes with each cycle and that `limits:` permits.
std::int64_t RandomUser::any_value(SignalIndex signal, std::uint64_t cycle) const {
  std::int64_t most = (1LL << (plan_.layout.signals[signal].bits - 1)) - 1;
  const auto limit = std::ranges::find(plan_.limits.outputs, signal, &OutputLimit::signal);
  const bool limited = limit != plan_.limits.outputs.end();
  if (limited && limit->high < static_cast<double>(most)) {
    most = std::max<std::int64_t>(0, static_cast<std::int64_t>(limit->high));
  }
  return static_cast<std::int64_t>(cycle) % (most + 1);
}

void RandomUser::ask(Time now) {
  if (random_.chance(0.05)) submit(request(), now);
}

Request RandomUser::request() {
  using enum RequestKind;
  constexpr std::array<NmtCommand, 5> commands{
      NmtCommand::start, NmtCommand::stop, NmtCommand::enter_preoperational, NmtCommand::reset_node,
      NmtCommand::reset_communication};
  constexpr std::array<Time, 4> timeouts{0ms, 5ms, 50ms, 300ms};
  Request request;
  const auto nodes = static_cast<std::uint32_t>(plan_.nodes.size());
  request.node = random_.chance(0.05) ? static_cast<std::uint8_t>(random_.below(128))
                                      : plan_.nodes[random_.below(nodes)].id.value();
  request.timeout = timeouts[random_.below(timeouts.size())];
  request.command = commands[random_.below(commands.size())];
  constexpr std::array often{sdo_upload,   sdo_upload, sdo_download,
                             sdo_download, pdo_poll,   pdo_exchange};
  request.kind = random_.chance(0.03) ? nmt : often[random_.below(often.size())];
  choose_object(request);
  return request;
}

void RandomUser::choose_object(Request& request) {
  if (request.kind == RequestKind::pdo_poll || request.kind == RequestKind::pdo_exchange) {
    request.object = {static_cast<std::uint16_t>(random_.below(6)), 0};
    request.size = static_cast<std::uint16_t>(random_.below(9));
    return;
  }
  constexpr std::array<ObjectKey, 8> readable{{{0x1000, 0},
                                               {0x1008, 0},
                                               {0x1018, 1},
                                               {0x1018, 9},
                                               {0x1003, 0},
                                               {0x6041, 0},
                                               {0x5FFF, 0},
                                               {0x1A00, 1}}};
  constexpr std::array<ObjectKey, 5> writable{
      {{0x6081, 0}, {0x1000, 0}, {0x5FFF, 1}, {0x1003, 0}, {0x1008, 0}}};
  const bool download = request.kind == RequestKind::sdo_download;
  request.object = download ? writable[random_.below(writable.size())]
                            : readable[random_.below(readable.size())];
  if (!download) return;
  request.size = static_cast<std::uint16_t>(random_.chance(0.8) ? 1 + random_.below(8)
                                                                : random_.below(request_bytes + 1));
  for (std::size_t i = 0; i < request.size; ++i) request.data[i] = std::byte(random_.below(256));
}

void RandomUser::submit(Request request, Time now) {
  request.id = asked_ + 1;
  if (!exchange_.requests.push(request)) return;
  ++asked_;
  if (request.kind == RequestKind::nmt && request.node == plan_.master_id.value()) judge_.ordered();
  open_.emplace(request.id, now);
}

void RandomUser::take_replies(Time now) {
  for (Reply reply; exchange_.replies.pop(reply);) {
    if (open_.erase(reply.id) == 0) {
      verdict_.report_violation("every request is answered once",
                                "request " + std::to_string(reply.id) + " is answered again");
    }
  }
  if (!open_.empty() && now - open_.begin()->second > reply_limit) {
    verdict_.report_violation(
        "every request is answered once",
        "request " + std::to_string(open_.begin()->first) + " has no answer after 120 s");
  }
}

void RandomUser::reset_all(Time now) {
  Request request;
  request.kind = RequestKind::nmt;
  request.command = NmtCommand::reset_node;
  submit(request, now);
}

}  // namespace takt::soak
