#include "apps/takt/live/daemon_client.hpp"

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <optional>
#include <unistd.h>

#include "master/lcm/channel_names.hpp"
#include "master/lcm/envelope/key_file.hpp"
#include "master/lcm/printable_text.hpp"
#include "master/lcm/random_number.hpp"
#include "master/linux/clock.hpp"

namespace takt {
namespace {

constexpr Time find_limit = std::chrono::milliseconds{2500};
/// The daemon reports refusals of the same kind once a second. A request that it may have refused
/// without a report is sent again after this time; a request that it has accepted is served once.
constexpr Time refusal_pause = std::chrono::milliseconds{1100};
constexpr Time settle =
    std::chrono::milliseconds{250};  // every bus sends a status within this time

/// Returns true if the status names the bus of its own channel, as that of every daemon does. A
/// message that names another bus does not count, so that the user need not choose between the two.
bool has_status(std::string_view bus, const BusView& view) {
  return view.status() &&
         bus_of_channel(channel_name(view.status()->bus, "STATUS"), "STATUS") == bus;
}

std::string names_of(const BusViews& views) {
  std::string names;
  for (const auto& [bus, view] : views.buses()) {
    if (!has_status(bus, view)) continue;
    names += (names.empty() ? "" : ", ") + view.status()->bus;
  }
  return names;
}

std::expected<status_t, LiveError> choose(const BusViews& views, const LcmClient& lcm,
                                          const std::string& bus_name) {
  const auto buses = chosen(views, bus_name);
  if (buses.empty()) return std::unexpected{no_bus(views, lcm, bus_name)};
  if (auto two = two_daemons(buses)) return std::unexpected{std::move(*two)};
  if (buses.size() > 1) {
    return std::unexpected{
        LiveError{"LCM carries several buses: " + names_of(views) + "; choose with --bus-name", 2}};
  }
  return *buses.front()->status();
}

/// Returns an id that is unique among all programs that send requests at the same time.
std::int64_t new_request_id() { return realtime_now().count(); }

}  // namespace

std::vector<const BusView*> chosen(const BusViews& views, const std::string& bus_name) {
  std::vector<const BusView*> buses;
  for (const auto& [bus, view] : views.buses()) {
    if (!has_status(bus, view)) continue;
    if (bus_name.empty() || view.status()->bus == bus_name || bus == bus_name) {
      buses.push_back(&view);
    }
  }
  return buses;
}

std::optional<LiveError> two_daemons(const std::vector<const BusView*>& buses) {
  const auto found = std::ranges::find_if(buses, &BusView::two_daemons);
  if (found == buses.end()) return std::nullopt;
  return LiveError{
      "two daemons run a bus named '" + (*found)->status()->bus +
          "' on this LCM, and --bus-name can't choose between them; stop one daemon, or give each "
          "its own LCM URL (`lcm: {url: ...}`) and choose with --lcm-url. If the right daemon has "
          "`authenticate: images`, --check-images accepts only its messages",
      3};
}

LiveError no_bus(const BusViews& views, const LcmClient& lcm, const std::string& bus_name) {
  const std::string others = names_of(views);
  if (!others.empty()) return {"there is no bus '" + bus_name + "'; the buses are: " + others, 2};
  const std::string which = bus_name.empty() ? std::string{} : " for bus '" + bus_name + "'";
  return {"no daemon" + which + " answers on " + lcm.where() +
              ". Is taktd running? At its start taktd prints the LCM_DEFAULT_URL to set",
          3};
}

void listen(LcmClient& lcm, BusViews& views, Time until, const std::function<bool()>& enough) {
  std::string reported;
  while (!enough() && monotonic_now() < until) {
    lcm.serve(
        [&](std::string_view channel, std::span<const std::byte> data) {
          const std::string trouble = views.take(channel, data);
          if (trouble.empty() || trouble == reported) return;
          reported = trouble;
          std::fprintf(stderr, "takt: %s\n", printable_text(trouble).c_str());
        },
        until);
  }
}

std::expected<LcmClient, LiveError> open_live(const LiveOptions& options,
                                              const std::vector<std::string>& patterns) {
  std::optional<WatchedKeyFile> signers;
  if (options.check_images) {
    if (options.keys.empty()) {
      return std::unexpected{LiveError{"--check-images needs a key file: --keys FILE", 2}};
    }
    auto keys = WatchedKeyFile::open(options.keys);
    if (!keys) return std::unexpected{LiveError{keys.error(), 2}};
    signers = std::move(*keys);
  }
  auto lcm = LcmClient::open(options.lcm_url, patterns, signers);
  if (!lcm) return std::unexpected{LiveError{lcm.error(), 3}};
  return std::move(*lcm);
}

std::expected<DaemonClient, LiveError> DaemonClient::find(const LiveOptions& options) {
  std::optional<EnvelopeSeal> seal;
  if (!options.keys.empty()) {
    const auto keys = load_keys(options.keys);
    if (!keys) return std::unexpected{LiveError{keys.error(), 2}};
    seal.emplace(keys->front(), random_number());
  }
  auto lcm = open_live(
      options, {any_bus("STATUS"), any_bus("REPLY"), any_bus("TRANSFER_STATE"), any_bus("EVENT")});
  if (!lcm) return std::unexpected{lcm.error()};
  BusViews views;
  const auto found = [&] { return !chosen(views, options.bus_name).empty(); };
  listen(*lcm, views, monotonic_now() + find_limit, found);
  if (found()) listen(*lcm, views, monotonic_now() + settle, [] { return false; });
  auto status = choose(views, *lcm, options.bus_name);
  if (!status) return std::unexpected{status.error()};
  return DaemonClient{std::move(*lcm), std::move(*status), std::move(seal)};
}

void DaemonClient::send(std::string_view what, Bytes message) {
  const std::string channel = channel_name(status_.bus, what);
  if (!seal_) return lcm_.publish(channel, message);
  lcm_.publish(channel_name(status_.bus, "SECURED"),
               seal_->seal(channel, message, status_.session, realtime_now()));
}

std::expected<std::int16_t, LiveError> DaemonClient::node(const std::string& text) const {
  if (text == "all") return std::int16_t{0};
  const auto id = parse_node_id(text);
  std::string known;
  for (const node_status_t& node : status_.nodes) {
    if (node.name == text || (id && node.node_id == id->value())) return node.node_id;
    known += (known.empty() ? "" : ", ") + std::to_string(node.node_id) + " " + node.name;
  }
  return std::unexpected{LiveError{
      "bus '" + status_.bus + "' has no node '" + text + "'; the nodes are: " + known, 2}};
}

std::expected<reply_t, LiveError> DaemonClient::ask(request_t request, Time limit) {
  std::vector<std::byte> buffer;
  request.schema = message_schema;
  request.utime = std::chrono::duration_cast<std::chrono::microseconds>(realtime_now()).count();
  request.session = status_.session;
  request.id = new_request_id();
  request.sender = "takt-" + std::to_string(::getpid());
  const Bytes message = encode(request, buffer);
  const std::string answers = channel_name(status_.bus, "REPLY");
  const Time until = monotonic_now() + limit;
  Time repeat_at = seal_ ? until : monotonic_now() + refusal_pause;
  std::optional<reply_t> answer;
  send("REQUEST", message);
  while (!answer && !lacks_key_ && monotonic_now() < until) {
    serve(
        [&](std::string_view channel, Bytes data) {
          if (channel != answers) return;
          auto reply = decode<reply_t>(data);
          const bool ours = reply && reply->id == request.id && reply->sender == request.sender;
          if (ours) answer = std::move(*reply);
        },
        std::min(until, repeat_at));
    if (monotonic_now() < repeat_at) continue;
    repeat_at = until;
    if (!answer) send("REQUEST", message);
  }
  if (answer) return std::move(*answer);
  return std::unexpected{silence()};
}

void DaemonClient::serve(const MessageHandler& handler, Time until) {
  const std::string events = channel_name(status_.bus, "EVENT");
  lcm_.serve(
      [&](std::string_view channel, Bytes data) {
        if (channel == events && !seal_) note_event(data);
        handler(channel, data);
      },
      until);
}

/// The event may be about another program, but what is refused there is refused here too.
void DaemonClient::note_event(Bytes data) {
  const auto event = decode<event_t>(data);
  if (!event || event->kind != "envelope_refused" || event->session != status_.session) return;
  for (const char* const what : {"REQUEST", "TRANSFER"}) {
    lacks_key_ |= event->text.find(' ' + channel_name(status_.bus, what) + ' ') != event->text.npos;
  }
}

LiveError DaemonClient::silence() const {
  const std::string daemon = "the daemon of bus '" + status_.bus + "'";
  if (lacks_key_) {
    return {daemon +
                " accepts requests only from programs with a key: name its key file with --keys "
                "FILE, or TAKT_KEYS=FILE in the environment",
            3};
  }
  return {daemon + " did not answer" +
              (seal_ ? "; does it have this key in `lcm: {keys: ...}`?"
                     : "; does it require a key (--keys)?"),
          3};
}

}  // namespace takt
