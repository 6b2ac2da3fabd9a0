#include "master/lcm/link/lcm_link.hpp"

#include <cerrno>
#include <cstring>
#include <fmt/format.h>
#include <utility>

#include "master/lcm/tcpq/tcpq_broker.hpp"
#include "master/lcm/tcpq/tcpq_client.hpp"
#include "master/linux/start_thread.hpp"

namespace takt {
namespace {

constexpr std::chrono::seconds retry_pause{5};

constexpr const char* by_environment =
    ". LCM_DEFAULT_URL names this hub. The program that serves it can read and change every "
    "message. If you trust it, name the hub with --lcm-url or `lcm: {url: ...}` instead";

std::string port_is_taken(std::uint16_t port) {
  return fmt::format(
      "port {0} of loopback is used by another program, so taktd can't serve a hub there; it tries "
      "again every 5 s. End that program; or, if you trust its hub, name this hub: --lcm-url "
      "tcpq://127.0.0.1:{0}, or `lcm: {{url: ...}}` without `broker`",
      port);
}

}  // namespace

LcmLink::LcmLink(LcmUrl url, Hub hub, std::vector<std::string> patterns, Say say)
    : url_{std::move(url)}, hub_{hub}, say_{std::move(say)}, patterns_{std::move(patterns)} {
  if (hub_ == Hub::own) {
    begin_hub();
  } else if (url_.scheme == "tcpq") {
    open_tcpq(url_);
  } else {
    begin_lcm();
  }
}

/// Starts the hub of the daemon. With Hub::own (`broker: true`), the daemon serves its own hub or
/// runs without a hub.
void LcmLink::begin_hub() {
  next_try_ = std::chrono::steady_clock::now() + retry_pause;
  const std::uint16_t port = url_.scheme == "tcpq" ? url_.port : tcpq::default_port;
  if (!serve_hub(port)) warn_once("LCM: " + port_is_taken(port));
}

void LcmLink::try_again() {
  if (std::chrono::steady_clock::now() < next_try_) return;
  return hub_ == Hub::own ? begin_hub() : begin_lcm();
}

void LcmLink::warn_once(const std::string& sentence) {
  if (std::exchange(reported_, sentence) != sentence) say_(Weight::warning, sentence);
}

std::expected<std::unique_ptr<TcpqBroker>, int> LcmLink::listen(std::uint16_t port) {
  const auto say = [this](Weight weight) {
    return [this, weight](const std::string& sentence) { say_(weight, sentence); };
  };
  return TcpqBroker::listen(port, {.say = say(Weight::note), .warn = say(Weight::warning)});
}

bool LcmLink::serve_hub(std::uint16_t port) {
  auto hub = listen(port);
  if (!hub) return false;
  say_(Weight::note,
       "LCM: taktd serves the tcpq protocol itself; other programs: export LCM_DEFAULT_URL=" +
           (*hub)->url());
  use(std::move(*hub));
  return true;
}

void LcmLink::open_tcpq(const LcmUrl& url) {
  const bool local = url.address.starts_with("127.");
  const bool answers = tcpq_server_answers(url.address, url.port, hub_answer_limit);
  if (!answers && local && serve_hub(url.port)) return;
  auto client = std::make_unique<TcpqClient>(url.address, url.port);
  const bool chosen = hub_ == Hub::named;
  say_(answers && chosen ? Weight::note : Weight::warning,
       fmt::format("LCM: {}{}",
                   answers ? "taktd uses the hub at " + client->url()
                           : "no hub answers at " + client->url() + "; taktd keeps trying",
                   chosen ? "" : by_environment));
  use(std::move(client));
}

void LcmLink::use(std::unique_ptr<Transport> transport) {
  for (const std::string& pattern : patterns_) transport->subscribe(pattern);
  main_ = std::move(transport);
}

void LcmLink::begin_lcm() {
  next_try_ = std::chrono::steady_clock::now() + retry_pause;
  if (url_.scheme == "udpm") {
    const std::string obstacle = multicast_obstacle(url_);
    if (!obstacle.empty()) return fall_back(obstacle);
  }
  // With the first subscription, LCM tests multicast for up to ten seconds. The test runs in a
  // thread beside the front thread, and taktd does not wait for it at its end.
  std::promise<std::unique_ptr<LcmTransport>> promise;
  auto opening = promise.get_future();
  auto thread =
      start_thread([promise = std::move(promise), url = url_.text, patterns = patterns_]() mutable {
        auto lcm = LcmTransport::create(url);
        for (const std::string& pattern : patterns) {
          if (lcm) lcm->subscribe(pattern);
        }
        if (lcm && !lcm->good()) lcm.reset();
        promise.set_value(std::move(lcm));
      });
  if (!thread) {
    return warn_once(std::string{"LCM: no thread can be created to open it: "} +
                     std::strerror(thread.error()) + "; taktd tries again every 5 s");
  }
  thread->detach();
  opening_ = std::move(opening);
}

void LcmLink::finish_lcm() {
  if (opening_.wait_for(std::chrono::seconds{0}) != std::future_status::ready) return;
  next_try_ = std::chrono::steady_clock::now() + retry_pause;
  std::unique_ptr<LcmTransport> lcm = opening_.get();
  if (!lcm) return fall_back("the self-test of LCM failed for " + url_.text);
  say_(Weight::note, "LCM: " + url_.text +
                         (url_.text.find("ttl=0") != std::string::npos ? " (this host only)" : ""));
  main_ = std::move(lcm);
}

void LcmLink::fall_back(const std::string& why) {
  if (fallback_) return;
  auto hub = listen(tcpq::default_port);
  if (hub) {
    fallback_ = std::move(*hub);
  } else if (hub.error() == EADDRINUSE) {
    return warn_once("LCM: " + why + "; " + port_is_taken(tcpq::default_port));
  } else {
    return warn_once("LCM: " + why +
                     "; a hub on loopback is not possible either: " + std::strerror(hub.error()));
  }
  for (const std::string& pattern : patterns_) fallback_->subscribe(pattern);
  say_(Weight::note, "LCM: " + why +
                         ". taktd serves LCM's tcpq protocol on loopback instead; other programs: "
                         "export LCM_DEFAULT_URL=" +
                         fallback_->url());
}

bool LcmLink::publish(const std::string& channel, std::span<const std::byte> data) {
  const bool by_main = main_ && main_->publish(channel, data);
  const bool by_fallback = fallback_ && fallback_->publish(channel, data);
  return by_main || by_fallback;
}

bool LcmLink::wanted(std::string_view channel) const {
  return (main_ && main_->wanted(channel)) || (fallback_ && fallback_->wanted(channel));
}

void LcmLink::subscribe(const std::string& pattern) {
  patterns_.push_back(pattern);
  if (main_) main_->subscribe(pattern);
  if (fallback_) fallback_->subscribe(pattern);
}

void LcmLink::serve(const MessageHandler& handler) {
  if (opening_.valid()) finish_lcm();
  if (main_) {
    main_->serve(handler);
    if (!main_->good()) main_.reset();
  } else if (!opening_.valid()) {
    try_again();
  }
  if (fallback_) fallback_->serve(handler);
}

bool LcmLink::drained() const {
  return (!main_ || main_->drained()) && (!fallback_ || fallback_->drained());
}

void LcmLink::watch(std::vector<pollfd>& descriptors) const {
  if (main_) main_->watch(descriptors);
  if (fallback_) fallback_->watch(descriptors);
}

std::string LcmLink::url() const {
  if (main_) return main_->url();
  return fallback_ ? fallback_->url() : std::string{};
}

}  // namespace takt
