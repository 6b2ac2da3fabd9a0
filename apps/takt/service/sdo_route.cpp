#include "apps/takt/service/sdo_route.hpp"

#include <chrono>
#include <fmt/format.h>
#include <span>
#include <utility>

#include "master/core/request.hpp"

namespace takt {
namespace {

/// Without a daemon there is no network file, so nothing else gives a time-out.
constexpr std::chrono::milliseconds direct_timeout{1000};
/// The longest time that a daemon may take for a request. The daemon uses the time-out of the node,
/// which this program does not know. A node with a longer time-out needs --timeout.
constexpr std::chrono::milliseconds longest_wait_for_daemon = std::chrono::seconds{30};

}  // namespace

SdoRoute::SdoRoute(const SdoRouteOptions& options)
    : options_{options}, timeout_ms_{options.timeout_ms} {
  if (options.bus.empty()) {
    daemon_.emplace(DaemonClient::find(options.live));
    node_ = daemon_->node(options.node);
    if (node_ == 0) throw Failure{"an SDO transfer needs one node, not `all`", 2};
    return;
  }
  if (!options.device_files.network.empty()) device();
  const auto id = device_ ? device_->id : parse_node_id(options.node);
  if (!id) {
    throw Failure{"'" + options.node +
                      "' is not a node id 1..127; --bus does not use the daemon, which knows "
                      "names: give the network file with --network FILE",
                  2};
  }
  node_ = id->value();
  const std::chrono::milliseconds given{options.timeout_ms};
  direct_.emplace(options.bus, *id, given.count() == 0 ? direct_timeout : given);
}

const KnownDevice& SdoRoute::device() {
  if (device_) return *device_;
  const DeviceFileOptions& files = options_.device_files;
  if (daemon_ && files.network.empty()) {
    device_ = device_of_daemon(*daemon_, options_.live, node_);
    if (files.eds.empty()) return *device_;
    KnownDevice described = device_of_eds(files.eds, device_->id);
    device_->file = std::move(described.file);
    device_->dictionary = std::move(described.dictionary);
  } else if (files.given()) {
    device_ = device_of_files(files, options_.node);
  } else {
    throw Failure{
        "without a daemon, takt does not know the names and types of objects: give "
        "--network FILE or --eds FILE",
        2};
  }
  return *device_;
}

ChosenObject SdoRoute::object(const std::string& word, const char* examples) {
  if (const auto key = parse_object(word)) return {*key};
  if (is_object_name(word)) return find_object(device(), word);
  throw Failure{"'" + word + "' is not an object like " + examples, 2};
}

reply_t SdoRoute::ask(const char* service, ObjectKey object, const SdoValue& value) {
  request_t request = make_request(service, node_);
  request.index = object.index;
  request.sub = object.sub;
  request.timeout_ms = timeout_ms_;
  set_data(request, value);
  // The daemon may serve other requests first, and each segment may take up to the time-out.
  const std::chrono::milliseconds given{timeout_ms_};
  return daemon_->demand(std::move(request), given.count() == 0
                                                 ? longest_wait_for_daemon
                                                 : given * 10 + std::chrono::seconds{2});
}

SdoValue SdoRoute::upload(ObjectKey object) {
  if (direct_) return direct_->upload(object);
  const reply_t reply = ask("sdo_upload", object, {});
  const auto bytes = std::as_bytes(std::span{reply.data});
  return {bytes.begin(), bytes.end()};
}

void SdoRoute::download(ObjectKey object, const SdoValue& value) {
  if (direct_) return direct_->download(object, value);
  if (value.size() > request_bytes) {
    throw Failure{fmt::format("the daemon takes at most {} bytes as one value; write a longer one "
                              "from a file with `takt sdo download`",
                              request_bytes),
                  1};
  }
  ask("sdo_download", object, value);
}

SdoValue SdoRoute::upload_file(ObjectKey object, std::size_t limit, const Progress& progress) {
  if (direct_) return direct_->upload(object, limit, progress);
  return FileTransfer{*daemon_, {node_, object, timeout_ms_}, progress}.upload(limit);
}

void SdoRoute::download_file(ObjectKey object, const SdoValue& value, const Progress& progress) {
  if (direct_) return direct_->download(object, value, progress);
  FileTransfer{*daemon_, {node_, object, timeout_ms_}, progress}.download(value);
}

}  // namespace takt
