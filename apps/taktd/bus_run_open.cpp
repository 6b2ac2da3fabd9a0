// Member functions of BusRun that open everything and look for another master before the first
// frame is sent.
#include <algorithm>
#include <chrono>
#include <cstring>
#include <iterator>
#include <utility>

#include "apps/taktd/bus_choice.hpp"
#include "apps/taktd/bus_run.hpp"
#include "apps/taktd/process/stop_signal.hpp"
#include "eds_parser/lcm/lcm_channel.hpp"
#include "eds_parser/print/plan/plan_fingerprint.hpp"
#include "master/linux/clock.hpp"
#include "master/linux/transient_error.hpp"

namespace takt {
namespace {

// Times of the search for another master. LCM may need a moment to connect; a master publishes its
// status at 10 Hz.
constexpr Time lcm_connect_timeout = std::chrono::seconds{1};
constexpr Time status_listening = std::chrono::milliseconds{250};
constexpr Time look = std::chrono::milliseconds{10};

}  // namespace

std::optional<Exit> BusRun::open() {
  auto url = parse_lcm_url(choose_lcm_url(front_.options.lcm_url, network_.lcm.url));
  if (!url) return refuse(Exit::wrong_use, url.error());
  if (const auto failure = open_gateway()) return failure;
  auto bus = OpenedBus::open(bus_name_, network_.plan, network_.devices, network_.realtime.spin);
  if (!bus) return refuse(Exit::bus_failure, bus.error().message);
  bus_ = std::move(*bus);
  for (const std::string& warning : bus_->warnings()) say(Weight::warning, warning);
  if (const auto failure = open_black_box()) return failure;
  return open_lcm(std::move(*url));
}

std::optional<Exit> BusRun::open_gateway() {
  const std::string& where = front_.options.gateway;
  if (where.empty()) return std::nullopt;
  auto gateway = AsciiFront::open(where, network_.plan,
                                  [this](const auto& sentence) { say(Weight::warning, sentence); });
  if (!gateway) return refuse(Exit::wrong_use, gateway.error());
  gateway_ = std::move(*gateway);
  say(Weight::note, "CiA 309-3 gateway on " + gateway_->where());
  return std::nullopt;
}

std::optional<Exit> BusRun::open_lcm(LcmUrl url) {
  const Channels channels{network_.plan.name};
  std::vector<std::string> heard = channels.heard();
  if (network_.lcm.typed) {
    std::ranges::move(TypedChannels::heard(network_.plan), std::back_inserter(heard));
  }
  const std::vector<std::string> guarded = heard;
  heard.push_back(channels.status);  // its messages reveal another master
  heard.push_back(channel_name(network_.plan.name, "SECURED"));
  const bool by_environment = lcm_url_is_from_environment(front_.options.lcm_url, network_.lcm.url);
  const LcmLink::Hub hub = network_.lcm.broker && front_.options.lcm_url.empty() ? LcmLink::Hub::own
                           : by_environment ? LcmLink::Hub::by_environment
                                            : LcmLink::Hub::named;
  link_ = std::make_unique<LcmLink>(
      std::move(url), hub, std::move(heard),
      [this](Weight weight, const std::string& sentence) { say(weight, sentence); });
  if (const auto failure = open_keys(guarded)) return failure;
  return look_for_master();
}

/// If the bus has keys, every message that commands the bus must come in an envelope.
std::optional<Exit> BusRun::open_keys(std::vector<std::string> guarded) {
  const auto file = key_file(front_.options, network_);
  if (file.empty()) return std::nullopt;
  auto keys = WatchedKeyFile::open(file);
  if (!keys) return refuse(Exit::wrong_use, keys.error());
  secured_ = std::make_unique<SecuredTransport>(
      *link_, front_.clocks, std::move(*keys),
      SecuredTransport::Options{
          .bus = network_.plan.name,
          .session = session_,
          .guarded = std::move(guarded),
          .signs = network_.lcm.signs,
          .say = [this](const std::string& sentence) { on_refused_envelope(sentence); }});
  return std::nullopt;
}

std::optional<Exit> BusRun::claim() {
  if (front_.options.observe) return std::nullopt;
  auto claim = BusClaim::take(BusName::parse(bus_name_));
  if (!claim) return refuse(Exit::bus_failure, claim.error().message);
  claim_.emplace(std::move(*claim));
  return std::nullopt;
}

/// Runs before the first frame is sent. Refuses to start if the bus already has a master.
std::optional<Exit> BusRun::look_for_master() {
  if (front_.options.observe) return std::nullopt;
  using enum OtherMaster::StatusCounts;
  OtherMaster other{network_.plan, bus_name_, session_, secured_ ? as_warning : as_refusal};
  listen(other);
  for (const std::string& warning : other.warnings()) say(Weight::warning, warning);
  if (other.refusal()) return refuse(Exit::bus_failure, *other.refusal());
  if (StopSignal::count() == 0) return std::nullopt;
  say(Weight::note, "a stop was requested before the start");
  return Exit::good;
}

/// Listens for another master on the bus and on LCM. Commands that arrive during this time are
/// dropped, because their senders cannot yet have received a message of this master.
void BusRun::listen(OtherMaster& other) {
  DiagnosticSocket* const listener = bus_->diagnostics();
  const std::string status = Channels{network_.plan.name}.status;
  const Time begin = front_.clocks.now();
  Time until = begin + lcm_connect_timeout;
  const Time frames_until = listener != nullptr ? begin + other.listening_time() : begin;
  bool lcm_is_there = false;
  std::vector<pollfd> descriptors;
  for (Time now = begin; now < std::max(frames_until, until); now = front_.clocks.now()) {
    if (other.refusal() || StopSignal::count() > 0) return;
    descriptors.clear();
    if (listener != nullptr) {
      descriptors.push_back({.fd = listener->fd(), .events = POLLIN, .revents = 0});
    }
    link_->watch(descriptors);
    front_.wait.wait(descriptors, never, std::min(std::max(frames_until, until), now + look));
    if (listener != nullptr)
      listener->poll([&](const StampedFrame& heard) { other.on_frame(heard.frame); });
    link_->serve([&](std::string_view channel, Bytes data) {
      if (channel != status) return;
      if (const auto message = decode<status_t>(data)) other.on_status(*message, realtime_now());
    });
    if (lcm_is_there || link_->url().empty()) continue;
    lcm_is_there = true;
    until = front_.clocks.now() + (link_->url().starts_with("memq") ? Time{0} : status_listening);
  }
}

std::optional<Exit> BusRun::open_black_box() {
  const RecordingOptions& wanted = network_.recording;
  const std::string& folder =
      front_.options.black_box.empty() ? wanted.folder : front_.options.black_box;
  if (folder.empty()) return std::nullopt;
  RecordingHead head{.bus = network_.plan.name,
                     .interface = network_.plan.interface,
                     .network = front_.options.network_file,
                     .fingerprint = plan_fingerprint(network_.plan),
                     .observe = front_.options.observe};
  const auto opened = recorder_.open({.folder = folder, .bytes = wanted.bytes, .keep = wanted.keep},
                                     network_.plan, std::move(head));
  if (!opened) return refuse(Exit::wrong_use, opened.error());
  return std::nullopt;
}

}  // namespace takt
