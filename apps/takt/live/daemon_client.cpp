#include "apps/takt/live/daemon_client.hpp"

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <fmt/format.h>
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

/// Returns true if the status names the bus of the channel on which it came, as the status of every
/// daemon does. A message that names another bus does not count, so that the user need not choose
/// between the two buses.
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

/// Returns the only bus of the list.
const status_t& only(const std::vector<const BusView*>& buses, const BusViews& views) {
  refuse_two_daemons(buses);
  if (buses.size() > 1) {
    throw Failure{"LCM carries several buses: " + names_of(views) + "; choose with --bus-name", 2};
  }
  return *buses.front()->status();
}

}  // namespace

request_t make_request(const char* service, std::int16_t node) {
  request_t request{};
  request.service = service;
  request.node_id = node;
  return request;
}

std::string own_sender() { return fmt::format("takt-{}", ::getpid()); }

std::int64_t utime_now() {
  return std::chrono::duration_cast<std::chrono::microseconds>(realtime_now()).count();
}

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

std::vector<const BusView*> find_buses(LcmClient& lcm, BusViews& views,
                                       const std::string& bus_name) {
  const auto found = [&] { return !chosen(views, bus_name).empty(); };
  listen(lcm, views, monotonic_now() + find_limit, found);
  if (!found()) throw no_bus(views, lcm, bus_name);
  listen(lcm, views, monotonic_now() + settle, [] { return false; });
  return chosen(views, bus_name);
}

void refuse_two_daemons(const std::vector<const BusView*>& buses) {
  const auto found = std::ranges::find_if(buses, &BusView::two_daemons);
  if (found == buses.end()) return;
  throw Failure{
      "two daemons run a bus named '" + (*found)->status()->bus +
      "' on this LCM, and --bus-name can't choose between them; stop one daemon, or give each "
      "its own LCM URL (`lcm: {url: ...}`) and choose with --lcm-url. If the right daemon has "
      "`authenticate: images`, --check-images accepts only its messages"};
}

Failure no_bus(const BusViews& views, const LcmClient& lcm, const std::string& bus_name) {
  const std::string others = names_of(views);
  if (!others.empty()) {
    return Failure{"there is no bus '" + bus_name + "'; the buses are: " + others, 2};
  }
  const std::string which = bus_name.empty() ? std::string{} : " for bus '" + bus_name + "'";
  return Failure{"no daemon" + which + " answers on " + lcm.where() +
                 ". Is taktd running? At its start taktd prints the LCM_DEFAULT_URL to set"};
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

LcmClient open_live(const LiveOptions& options, const std::vector<std::string_view>& whats) {
  std::optional<WatchedKeyFile> signers;
  if (options.check_images) {
    if (options.keys.empty()) throw Failure{"--check-images needs a key file: --keys FILE", 2};
    signers = value_or_fail(WatchedKeyFile::open(options.keys), 2);
  }
  std::vector<std::string> patterns(whats.size());
  std::ranges::transform(whats, patterns.begin(), any_bus);
  return value_or_fail(LcmClient::open(options.lcm_url, patterns, signers), 3);
}

DaemonClient DaemonClient::find(const LiveOptions& options) {
  std::optional<EnvelopeSeal> seal;
  if (!options.keys.empty()) {
    seal.emplace(value_or_fail(load_keys(options.keys), 2).front(), random_number());
  }
  LcmClient lcm = open_live(options, {"STATUS", "REPLY", "TRANSFER_STATE", "EVENT"});
  BusViews views;
  const status_t status = only(find_buses(lcm, views, options.bus_name), views);
  return {std::move(lcm), status, std::move(seal)};
}

void DaemonClient::send(std::string_view what, Bytes message) {
  const std::string channel = channel_name(status_.bus, what);
  if (!seal_) return lcm_.publish(channel, message);
  lcm_.publish(channel_name(status_.bus, "SECURED"),
               seal_->seal(channel, message, status_.session, realtime_now()));
}

std::optional<std::int16_t> DaemonClient::find_node(const std::string& text) const {
  if (text == "all") return std::int16_t{0};
  const auto id = parse_node_id(text);
  const auto found = std::ranges::find_if(status_.nodes, [&](const node_status_t& node) {
    return node.name == text || (id && node.node_id == id->value());
  });
  return found == status_.nodes.end() ? std::nullopt : std::optional{found->node_id};
}

std::int16_t DaemonClient::node(const std::string& text) const {
  if (const auto found = find_node(text)) return *found;
  std::string known;
  for (const node_status_t& node : status_.nodes) {
    known += fmt::format("{}{} {}", known.empty() ? "" : ", ", node.node_id, node.name);
  }
  throw Failure{
      fmt::format("bus '{}' has no node '{}'; the nodes are: {}", status_.bus, text, known), 2};
}

reply_t DaemonClient::ask(request_t request, Time limit) {
  std::vector<std::byte> buffer;
  request.schema = message_schema;
  request.utime = utime_now();
  request.session = status_.session;
  request.id = realtime_now().count();  // unique among programs that ask at the same time
  request.sender = own_sender();
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
  if (!answer) throw silence();
  return std::move(*answer);
}

reply_t DaemonClient::demand(request_t request, Time limit) {
  reply_t reply = ask(std::move(request), limit);
  if (reply.good != 0) return reply;
  throw Failure{reply.text, 1, static_cast<std::uint32_t>(reply.abort_code)};
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

/// The event may be about another program, but the daemon then refuses messages of this program as
/// well.
void DaemonClient::note_event(Bytes data) {
  const auto event = decode<event_t>(data);
  if (!event || event->kind != "envelope_refused" || event->session != status_.session) return;
  for (const char* const what : {"REQUEST", "TRANSFER"}) {
    lacks_key_ |= event->text.find(' ' + channel_name(status_.bus, what) + ' ') != event->text.npos;
  }
}

Failure DaemonClient::silence() const {
  const std::string daemon = "the daemon of bus '" + status_.bus + "'";
  if (lacks_key_) {
    return Failure{daemon +
                   " accepts requests only from programs with a key: name its key file with --keys "
                   "FILE, or TAKT_KEYS=FILE in the environment"};
  }
  return Failure{daemon + " did not answer" +
                 (seal_ ? "; does it have this key in `lcm: {keys: ...}`?"
                        : "; does it require a key (--keys)?")};
}

}  // namespace takt
