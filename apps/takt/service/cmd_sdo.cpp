#include <CLI/CLI.hpp>
#include <chrono>
#include <cstdio>
#include <fstream>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>

#include "apps/command_line/bus_option.hpp"
#include "apps/command_line/commands.hpp"
#include "apps/command_line/interrupt.hpp"
#include "apps/command_line/json_text.hpp"
#include "apps/command_line/text_file.hpp"
#include "apps/command_line/whole_number.hpp"
#include "apps/takt/live/daemon_client.hpp"
#include "apps/takt/service/file_transfer.hpp"
#include "apps/takt/service/sdo_direct.hpp"
#include "apps/takt/service/transfer_progress.hpp"
#include "master/core/request.hpp"
#include "master/gateway/message/value_text.hpp"
#include "master/lcm/printable_text.hpp"

namespace takt {
namespace {

using Value = std::vector<std::byte>;

constexpr std::size_t most_file_bytes = 16 << 20;
/// Without a daemon there is no network file, so nothing else gives a time-out.
constexpr std::chrono::milliseconds direct_timeout{1000};
/// How long a daemon may take for a request with the time-out of the node, which this program does
/// not know. A node with a longer time-out needs --timeout.
constexpr std::chrono::milliseconds longest_wait_for_daemon = std::chrono::seconds{30};

struct SdoOptions {
  LiveOptions live;
  std::string bus;
  std::string node;
  std::string object;
  std::string type;
  std::string value;
  std::string file;
  int timeout_ms = 0;  ///< 0 means that of the node
  std::size_t limit = most_file_bytes;
};

/// Makes SDO transfers through the daemon or directly on the bus.
class SdoRoute {
 public:
  static std::expected<SdoRoute, LiveError> open(const SdoOptions& options);

  std::expected<Value, LiveError> upload(ObjectKey object);
  std::expected<void, LiveError> download(ObjectKey object, const Value& value);
  /// The same for files, which may be long: in parts, by block transfer and with progress.
  std::expected<Value, LiveError> upload_file(ObjectKey object, std::size_t limit,
                                              const Progress& progress);
  std::expected<void, LiveError> download_file(ObjectKey object, const Value& value,
                                               const Progress& progress);
  int node() const noexcept { return node_; }

 private:
  std::expected<reply_t, LiveError> ask(const char* service, ObjectKey object, const Value& value);

  std::optional<SdoDirect> direct_;
  std::optional<DaemonClient> daemon_;
  std::int16_t node_ = 0;
  int timeout_ms_ = 0;
};

std::expected<SdoRoute, LiveError> SdoRoute::open(const SdoOptions& options) {
  SdoRoute route;
  route.timeout_ms_ = options.timeout_ms;
  if (!options.bus.empty()) {
    const auto id = parse_node_id(options.node);
    if (!id) {
      return std::unexpected{LiveError{"'" + options.node +
                                           "' is not a node id 1..127; only a daemon "
                                           "knows names, and --bus does not use the daemon",
                                       2}};
    }
    route.node_ = id->value();
    const std::chrono::milliseconds given{options.timeout_ms};
    route.direct_.emplace(options.bus, *id, given.count() == 0 ? direct_timeout : given);
    return route;
  }
  auto daemon = DaemonClient::find(options.live);
  if (!daemon) return std::unexpected{daemon.error()};
  const auto node = daemon->node(options.node);
  if (!node) return std::unexpected{node.error()};
  if (*node == 0) return std::unexpected{LiveError{"an SDO transfer needs one node, not `all`", 2}};
  route.node_ = *node;
  route.daemon_.emplace(std::move(*daemon));
  return route;
}

std::expected<reply_t, LiveError> SdoRoute::ask(const char* service, ObjectKey object,
                                                const Value& value) {
  request_t request{};
  request.service = service;
  request.node_id = node_;
  request.index = object.index;
  request.sub = object.sub;
  request.timeout_ms = timeout_ms_;
  request.size = static_cast<std::int32_t>(value.size());
  for (const std::byte byte : value) request.data.push_back(std::to_integer<std::uint8_t>(byte));
  // The daemon may serve other requests first, and each segment may take up to the time-out.
  const std::chrono::milliseconds given{timeout_ms_};
  auto reply =
      daemon_->ask(std::move(request), given.count() == 0 ? longest_wait_for_daemon
                                                          : given * 10 + std::chrono::seconds{2});
  if (reply && reply->good == 0) return std::unexpected{LiveError{reply->text, 1}};
  return reply;
}

std::expected<Value, LiveError> SdoRoute::upload(ObjectKey object) {
  if (direct_) return direct_->upload(object);
  const auto reply = ask("sdo_upload", object, {});
  if (!reply) return std::unexpected{reply.error()};
  Value value;
  for (const std::uint8_t byte : reply->data) value.push_back(std::byte{byte});
  return value;
}

std::expected<void, LiveError> SdoRoute::download(ObjectKey object, const Value& value) {
  if (direct_) return direct_->download(object, value);
  if (value.size() > request_bytes) {
    return std::unexpected{LiveError{"the daemon takes at most " + std::to_string(request_bytes) +
                                         " bytes as one value; write a longer one from a file "
                                         "with `takt sdo download`",
                                     1}};
  }
  const auto reply = ask("sdo_download", object, value);
  if (!reply) return std::unexpected{reply.error()};
  return {};
}

std::expected<Value, LiveError> SdoRoute::upload_file(ObjectKey object, std::size_t limit,
                                                      const Progress& progress) {
  if (direct_) return direct_->upload(object, limit, progress);
  return FileTransfer{*daemon_, {node_, object, timeout_ms_}, progress}.upload(limit);
}

std::expected<void, LiveError> SdoRoute::download_file(ObjectKey object, const Value& value,
                                                       const Progress& progress) {
  if (direct_) return direct_->download(object, value, progress);
  return FileTransfer{*daemon_, {node_, object, timeout_ms_}, progress}.download(value);
}

int transfer_failed(const SdoOptions& options, ObjectKey object, const LiveError& error) {
  return complain("node " + options.node + " " + to_string(object) + ": " + error.sentence,
                  error.code);
}

int read(const SdoOptions& options) {
  const auto object = parse_object(options.object);
  if (!object) return complain("'" + options.object + "' is not an object like 6041 or 1018:1", 2);
  const auto type =
      options.type.empty() ? std::optional<DataType>{} : parse_data_type(options.type);
  if (!type && !options.type.empty()) {
    return complain("'" + options.type + "' is not a type like u16, i32, f32, string, hex", 2);
  }
  auto route = SdoRoute::open(options);
  if (!route) return complain(route.error().sentence, route.error().code);
  const auto value = route->upload(*object);
  if (!value) return transfer_failed(options, *object, value.error());
  if (type && !fits(*type, *value)) {
    return transfer_failed(options, *object, {misfit_text(options.type, *type, *value), 1});
  }
  const std::string text = type ? value_text(*type, *value) : untyped_text(*value);
  if (options.live.json) {
    const nlohmann::json json{{"node", route->node()},    {"index", object->index},
                              {"sub", object->sub},       {"size", value->size()},
                              {"data", hex_text(*value)}, {"text", text}};
    std::puts(json_text(json).c_str());
  } else {
    std::puts(printable_lines(text).c_str());
  }
  return 0;
}

int download_value(const SdoOptions& options, ObjectKey object, const Value& value) {
  auto route = SdoRoute::open(options);
  if (!route) return complain(route.error().sentence, route.error().code);
  const auto done = route->download(object, value);
  return done ? 0 : transfer_failed(options, object, done.error());
}

int write(const SdoOptions& options) {
  const auto object = parse_object(options.object);
  if (!object) return complain("'" + options.object + "' is not an object like 6041 or 1018:1", 2);
  const auto type = parse_data_type(options.type);
  if (!type) {
    return complain("'" + options.type + "' is not a type like u16, i32, f32, string, hex", 2);
  }
  const auto value = value_bytes(*type, options.value);
  if (!value) return complain(value.error(), 2);
  return download_value(options, *object, *value);
}

int upload_file(const SdoOptions& options) {
  const auto object = parse_object(options.object);
  if (!object) return complain("'" + options.object + "' is not an object like 1F50:1", 2);
  auto route = SdoRoute::open(options);
  if (!route) return complain(route.error().sentence, route.error().code);
  const Interrupt interrupt;
  TransferProgress progress;
  const auto value =
      route->upload_file(*object, options.limit,
                         [&](std::size_t done, std::size_t total) { progress.show(done, total); });
  if (!value) return transfer_failed(options, *object, value.error());
  progress.finish(value->size());
  std::ofstream file{options.file, std::ios::binary};
  file.write(reinterpret_cast<const char*>(value->data()),
             static_cast<std::streamsize>(value->size()));
  file.close();
  return file ? 0 : complain(options.file + ": can't be written", 2);
}

int download_file(const SdoOptions& options) {
  const auto object = parse_object(options.object);
  if (!object) return complain("'" + options.object + "' is not an object like 1F50:1", 2);
  const auto content = read_whole_file(options.file);
  if (!content) return complain(content.error(), 2);
  const auto bytes = std::as_bytes(std::span{*content});
  auto route = SdoRoute::open(options);
  if (!route) return complain(route.error().sentence, route.error().code);
  const Interrupt interrupt;
  TransferProgress progress;
  const auto done = route->download_file(
      *object, {bytes.begin(), bytes.end()},
      [&](std::size_t through, std::size_t total) { progress.show(through, total); });
  if (!done) return transfer_failed(options, *object, done.error());
  progress.finish(bytes.size());
  return 0;
}

CLI::App* add_verb(CLI::App& sdo, const char* name, const char* text,
                   const std::shared_ptr<SdoOptions>& options) {
  auto* verb = sdo.add_subcommand(name, text);
  verb->add_option("NODE", options->node, "node id or name")->required();
  verb->add_option("OBJ", options->object, "object 6041 or 1018:1; index and sub-index in hex")
      ->required();
  add_bus(*verb, options->bus, "work directly on can0 or unix:PATH, without a daemon")
      ->type_name("IFACE");
  add_number(*verb, "--timeout", options->timeout_ms,
             "longest silence of the device, ms (`sdo_timeout_ms` of the node; 1000 with --bus)")
      ->check(CLI::Range(1, 60000))
      ->type_name("MS");
  add_live_options(*verb, options->live);
  return verb;
}

}  // namespace

void add_sdo(CLI::App& app, int& exit_code) {
  auto* sdo = app.add_subcommand("sdo", "reads and writes objects of a device");
  sdo->require_subcommand(1);
  sdo->footer(
      "Examples:\n  takt sdo read 5 6041 u16\n  takt sdo read shoulder 1008\n"
      "  takt sdo write 5 6081 u32 1000\n  takt sdo upload 5 1021 drive.eds --bus can0\n"
      "  takt sdo download 5 1F50:1 firmware.bin --timeout 10000\n"
      "Files have at most 16 MiB; Ctrl-C aborts a transfer on the bus.\n"
      "Types: bool, i8..i64, u8..u64, f32, f64, string, hex.");
  auto options = std::make_shared<SdoOptions>();
  auto* reading = add_verb(*sdo, "read", "prints one value", options);
  reading->add_option("TYPE", options->type, "u16, i32, f32, string, hex ...");
  reading->callback([options, &exit_code] { exit_code = read(*options); });
  auto* writing = add_verb(*sdo, "write", "writes one value", options);
  writing->add_option("TYPE", options->type, "u16, i32, f32, string, hex ...")->required();
  writing->add_option("VALUE", options->value, "decimal, 0x hex, or text")->required();
  writing->callback([options, &exit_code] { exit_code = write(*options); });
  auto* uploading = add_verb(*sdo, "upload", "reads an object of the device into a file", options);
  uploading->add_option("FILE", options->file)->required();
  uploading
      ->add_option("--limit", options->limit,
                   "most bytes, as 64K or 2M; takt aborts a longer transfer (16M)")
      ->transform(CLI::AsSizeValue(false))
      ->transform(CLI::Validator{[](std::string& text) { return octal_trouble(text); }, ""})
      ->check(CLI::Range(std::size_t{1}, most_file_bytes))
      ->type_name("BYTES");
  uploading->callback([options, &exit_code] { exit_code = upload_file(*options); });
  auto* downloading =
      add_verb(*sdo, "download", "writes a file to an object of the device", options);
  downloading->add_option("FILE", options->file)->required();
  downloading->callback([options, &exit_code] { exit_code = download_file(*options); });
}

}  // namespace takt
