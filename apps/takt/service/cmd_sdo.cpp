#include <CLI/CLI.hpp>
#include <chrono>
#include <cstdio>
#include <fmt/format.h>
#include <fstream>
#include <functional>
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
  int timeout_ms = 0;  ///< 0 means the time-out of the node
  std::size_t limit = most_file_bytes;
};

/// Makes SDO transfers through the daemon or directly on the bus. A transfer that fails throws a
/// Failure.
class SdoRoute {
 public:
  explicit SdoRoute(const SdoOptions& options);

  Value upload(ObjectKey object);
  void download(ObjectKey object, const Value& value);
  /// These functions transfer files, which may be long: in parts, by block transfer and with
  /// progress.
  Value upload_file(ObjectKey object, std::size_t limit, const Progress& progress);
  void download_file(ObjectKey object, const Value& value, const Progress& progress);
  int node() const noexcept { return node_; }

 private:
  reply_t ask(const char* service, ObjectKey object, const Value& value);

  std::optional<SdoDirect> direct_;
  std::optional<DaemonClient> daemon_;
  std::int16_t node_ = 0;
  int timeout_ms_;
};

SdoRoute::SdoRoute(const SdoOptions& options) : timeout_ms_{options.timeout_ms} {
  if (options.bus.empty()) {
    daemon_.emplace(DaemonClient::find(options.live));
    node_ = daemon_->node(options.node);
    if (node_ == 0) throw Failure{"an SDO transfer needs one node, not `all`", 2};
    return;
  }
  const auto id = parse_node_id(options.node);
  if (!id) {
    throw Failure{"'" + options.node +
                      "' is not a node id 1..127; only a daemon knows names, and --bus does not "
                      "use the daemon",
                  2};
  }
  node_ = id->value();
  const std::chrono::milliseconds given{options.timeout_ms};
  direct_.emplace(options.bus, *id, given.count() == 0 ? direct_timeout : given);
}

reply_t SdoRoute::ask(const char* service, ObjectKey object, const Value& value) {
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

Value SdoRoute::upload(ObjectKey object) {
  if (direct_) return direct_->upload(object);
  const reply_t reply = ask("sdo_upload", object, {});
  const auto bytes = std::as_bytes(std::span{reply.data});
  return {bytes.begin(), bytes.end()};
}

void SdoRoute::download(ObjectKey object, const Value& value) {
  if (direct_) return direct_->download(object, value);
  if (value.size() > request_bytes) {
    throw Failure{fmt::format("the daemon takes at most {} bytes as one value; write a longer one "
                              "from a file with `takt sdo download`",
                              request_bytes),
                  1};
  }
  ask("sdo_download", object, value);
}

Value SdoRoute::upload_file(ObjectKey object, std::size_t limit, const Progress& progress) {
  if (direct_) return direct_->upload(object, limit, progress);
  return FileTransfer{*daemon_, {node_, object, timeout_ms_}, progress}.upload(limit);
}

void SdoRoute::download_file(ObjectKey object, const Value& value, const Progress& progress) {
  if (direct_) return direct_->download(object, value, progress);
  FileTransfer{*daemon_, {node_, object, timeout_ms_}, progress}.download(value);
}

/// Returns the object that the user names. If the text names no object, `examples` continues the
/// sentence of the Failure.
ObjectKey object_of(const SdoOptions& options, const char* examples = "6041 or 1018:1") {
  const auto object = parse_object(options.object);
  if (object) return *object;
  throw Failure{"'" + options.object + "' is not an object like " + examples, 2};
}

DataType type_of(const SdoOptions& options) {
  const auto type = parse_data_type(options.type);
  if (type) return *type;
  throw Failure{"'" + options.type + "' is not a type like u16, i32, f32, string, hex", 2};
}

/// Runs a transfer of this object. The sentence of a failure begins with node and object.
template <class Transfer>
auto transfer(const SdoOptions& options, ObjectKey object, const Transfer& run) {
  try {
    return run();
  } catch (const Failure& failure) {
    throw Failure{fmt::format("node {} {}: {}", options.node, to_string(object), failure.what()),
                  failure.code};
  }
}

int read(const SdoOptions& options) {
  const ObjectKey object = object_of(options);
  const auto type = options.type.empty() ? std::nullopt : std::optional{type_of(options)};
  SdoRoute route{options};
  const Value value = transfer(options, object, [&] {
    Value bytes = route.upload(object);
    if (type && !fits(*type, bytes)) throw Failure{misfit_text(options.type, *type, bytes), 1};
    return bytes;
  });
  const std::string text = type ? value_text(*type, value) : untyped_text(value);
  if (options.live.json) {
    const nlohmann::json json{{"node", route.node()},    {"index", object.index},
                              {"sub", object.sub},       {"size", value.size()},
                              {"data", hex_text(value)}, {"text", text}};
    std::puts(json_text(json).c_str());
  } else {
    std::puts(printable_lines(text).c_str());
  }
  return 0;
}

int write(const SdoOptions& options) {
  const ObjectKey object = object_of(options);
  const Value value = value_or_fail(value_bytes(type_of(options), options.value), 2);
  SdoRoute route{options};
  transfer(options, object, [&] { route.download(object, value); });
  return 0;
}

int upload_file(const SdoOptions& options) {
  const ObjectKey object = object_of(options, "1F50:1");
  SdoRoute route{options};
  const Interrupt interrupt;
  TransferProgress progress;
  const Value value = transfer(options, object, [&] {
    return route.upload_file(object, options.limit,
                             std::bind_front(&TransferProgress::show, &progress));
  });
  progress.finish(value.size());
  std::ofstream file{options.file, std::ios::binary};
  file.write(reinterpret_cast<const char*>(value.data()),
             static_cast<std::streamsize>(value.size()));
  file.close();
  return file ? 0 : complain(options.file + ": can't be written", 2);
}

int download_file(const SdoOptions& options) {
  const ObjectKey object = object_of(options, "1F50:1");
  const std::string content = value_or_fail(read_whole_file(options.file), 2);
  const auto bytes = std::as_bytes(std::span{content});
  SdoRoute route{options};
  const Interrupt interrupt;
  TransferProgress progress;
  transfer(options, object, [&] {
    route.download_file(object, {bytes.begin(), bytes.end()},
                        std::bind_front(&TransferProgress::show, &progress));
  });
  progress.finish(bytes.size());
  return 0;
}

AddedCommand<SdoOptions> add_verb(CLI::App& sdo, int& exit_code, const char* name, const char* text,
                                  int (*run)(const SdoOptions&)) {
  const auto added = add_command<SdoOptions>(sdo, exit_code, name, text, run);
  auto& [verb, options] = added;
  verb.add_option("NODE", options.node, "node id or name")->required();
  verb.add_option("OBJ", options.object, "object 6041 or 1018:1; index and sub-index in hex")
      ->required();
  add_bus(verb, options.bus, "work directly on can0 or unix:PATH, without a daemon")
      ->type_name("IFACE");
  add_number(verb, "--timeout", options.timeout_ms,
             "longest silence of the device, ms (`sdo_timeout_ms` of the node; 1000 with --bus)")
      ->check(CLI::Range(1, 60000))
      ->type_name("MS");
  add_live_options(verb, options.live);
  return added;
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
  auto [reading, read_options] = add_verb(*sdo, exit_code, "read", "prints one value", read);
  reading.add_option("TYPE", read_options.type, "u16, i32, f32, string, hex ...");
  auto [writing, write_options] = add_verb(*sdo, exit_code, "write", "writes one value", write);
  writing.add_option("TYPE", write_options.type, "u16, i32, f32, string, hex ...")->required();
  writing.add_option("VALUE", write_options.value, "decimal, 0x hex, or text")->required();
  auto [uploading, upload_options] =
      add_verb(*sdo, exit_code, "upload", "reads an object of the device into a file", upload_file);
  uploading.add_option("FILE", upload_options.file)->required();
  uploading
      .add_option("--limit", upload_options.limit,
                  "most bytes, as 64K or 2M; takt aborts a longer transfer (16M)")
      ->transform(CLI::AsSizeValue(false))
      ->transform(CLI::Validator{[](std::string& text) { return octal_error(text); }, ""})
      ->check(CLI::Range(std::size_t{1}, most_file_bytes))
      ->type_name("BYTES");
  auto [downloading, download_options] = add_verb(
      *sdo, exit_code, "download", "writes a file to an object of the device", download_file);
  downloading.add_option("FILE", download_options.file)->required();
}

}  // namespace takt
