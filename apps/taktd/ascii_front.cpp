#include "apps/taktd/ascii_front.hpp"

#include <utility>

#include "master/gateway/front_gap.hpp"

namespace takt {

AsciiFront::AsciiFront(const BusPlan& plan)
    : gateway_{
          plan,
          {.submit = [this](const Request& request) { return master_->submit(request); },
           .write =
               [this](const auto& signals, const auto& values) {
                 return bridge_->command("gateway", signals, values);
               },
           .send = [this](int client, const std::string& line) { server_->send(client, line); }}} {}

std::expected<std::unique_ptr<AsciiFront>, std::string> AsciiFront::open(
    const std::string& where, const BusPlan& plan,
    std::function<void(const std::string& sentence)> warn) {
  std::unique_ptr<AsciiFront> front{new AsciiFront{plan}};
  AsciiGateway& gateway = front->gateway_;
  auto server = AsciiServer::listen(
      where,
      {.connected = [&gateway](int client) { gateway.connect(client); },
       .line = [&gateway](int client, std::string_view line) { gateway.command(client, line); },
       .old_line =
           [&gateway](int client, std::string_view line, Time gap) {
             if (FrontGap::harms_requests(gap)) return gateway.refuse_waited(client, line, gap);
             gateway.refuse_waited_outputs(client, line, gap);
           },
       .too_long = [&gateway](int client) { gateway.refuse_long_line(client); },
       .gone = [&gateway](int client) { gateway.disconnect(client); },
       .awaits_reply = [&gateway](int client) { return gateway.awaits_reply(client); },
       .warn = std::move(warn)});
  if (!server) return std::unexpected{server.error()};
  front->server_ = std::move(*server);
  return front;
}

void AsciiFront::serve() {
  bridge_->notice_gap();
  const bool any = std::exchange(gaps_, bridge_->gaps()) != bridge_->gaps();
  const bool any_long = std::exchange(long_gaps_, bridge_->long_gaps()) != bridge_->long_gaps();
  if (any) server_->mark_waiting(any_long ? bridge_->newest_long_gap() : bridge_->newest_gap());
  server_->serve();
}

void AsciiFront::attach(MasterRun& master, Bridge& bridge) {
  master_ = &master;
  bridge_ = &bridge;
  bridge.register_guest(gateway_);
}

}  // namespace takt
