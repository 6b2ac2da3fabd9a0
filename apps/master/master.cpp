#include <algorithm>
#include <takt/master.hpp>
#include <utility>

#include "apps/master/master_state.hpp"

namespace takt {
namespace {

static_assert(std::to_underlying(NmtService::start) == std::to_underlying(NmtCommand::start));
static_assert(std::to_underlying(NmtService::stop) == std::to_underlying(NmtCommand::stop));
static_assert(std::to_underlying(NmtService::enter_preoperational) ==
              std::to_underlying(NmtCommand::enter_preoperational));
static_assert(std::to_underlying(NmtService::reset_node) ==
              std::to_underlying(NmtCommand::reset_node));
static_assert(std::to_underlying(NmtService::reset_communication) ==
              std::to_underlying(NmtCommand::reset_communication));

Request request_for(RequestKind kind, NodeObject object) {
  Request request;
  request.kind = kind;
  request.node = object.node;
  request.object = {object.index, object.sub};
  return request;
}

}  // namespace

std::expected<Master, std::string> Master::start(NetworkFile network, MasterOptions options) {
  if (!network.usable()) {
    const auto& findings = network.findings();
    const auto error = std::ranges::find(findings, true, &NetworkFinding::error);
    return std::unexpected{error->text};
  }
  const LoadedNetwork& loaded = network.state_->loaded;
  auto state = std::make_unique<State>(std::move(network), loaded, std::move(options));
  if (auto started = state->start(); !started) return std::unexpected{started.error()};
  return Master{std::move(state)};
}

Master::Master(std::unique_ptr<State> state) noexcept : state_{std::move(state)} {}
Master::~Master() = default;
Master::Master(Master&& other) noexcept = default;
Master& Master::operator=(Master&& other) noexcept = default;

const NetworkFile& Master::network() const noexcept { return state_->network(); }
const std::string& Master::realtime() const noexcept { return state_->realtime(); }
std::chrono::nanoseconds Master::now() const noexcept { return state_->now(); }

bool Master::wait(std::chrono::nanoseconds longest) { return state_->wait(longest); }
std::uint64_t Master::cycle() const noexcept { return state_->cycle(); }
std::chrono::nanoseconds Master::sync_time() const noexcept { return state_->sync_time(); }
double Master::value(std::size_t signal) const { return state_->value(signal); }
std::int64_t Master::raw(std::size_t signal) const { return state_->raw(signal); }
bool Master::stale(std::size_t signal) const { return state_->stale(signal); }

bool Master::set(std::size_t signal, double value) { return state_->set(signal, value); }
bool Master::set_raw(std::size_t signal, std::int64_t value) {
  return state_->set_raw(signal, value);
}
void Master::send() { state_->send(); }

NodeState Master::node(std::uint8_t node_id) const { return state_->node(node_id); }
bool Master::all_ready() const { return state_->all_ready(); }
std::optional<MasterEvent> Master::take_event() { return state_->take_event(); }

std::optional<RequestId> Master::read(NodeObject object) {
  Request request = request_for(RequestKind::sdo_upload, object);
  return state_->submit(request);
}

std::optional<RequestId> Master::write(NodeObject object, std::span<const std::byte> data) {
  if (data.empty() || data.size() > request_bytes) return std::nullopt;
  Request request = request_for(RequestKind::sdo_download, object);
  request.size = static_cast<std::uint16_t>(data.size());
  std::ranges::copy(data, request.data.begin());
  return state_->submit(request);
}

std::optional<RequestId> Master::nmt(NmtService service, std::uint8_t node_id) {
  Request request = request_for(RequestKind::nmt, {.node = node_id});
  request.command = static_cast<NmtCommand>(service);
  return state_->submit(request);
}

std::optional<ServiceReply> Master::take_reply() { return state_->take_reply(); }

void Master::request_stop() noexcept { state_->request_stop(); }
bool Master::stop() { return state_->stop(); }

}  // namespace takt
