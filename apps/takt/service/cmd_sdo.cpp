#include <CLI/CLI.hpp>
#include <cstdio>
#include <fmt/format.h>
#include <fstream>
#include <functional>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>

#include "apps/command_line/commands.hpp"
#include "apps/command_line/interrupt.hpp"
#include "apps/command_line/json_text.hpp"
#include "apps/command_line/text_file.hpp"
#include "apps/command_line/whole_number.hpp"
#include "apps/takt/objects/chosen_object.hpp"
#include "apps/takt/service/sdo_route.hpp"
#include "apps/takt/service/shared_options.hpp"
#include "apps/takt/service/transfer_progress.hpp"
#include "master/gateway/message/value_text.hpp"
#include "master/lcm/printable_text.hpp"

namespace takt {
namespace {

constexpr std::size_t most_file_bytes = 16 << 20;

struct SdoOptions : SdoRouteOptions {
  std::string object;
  std::string type;  ///< type of the value that is read; empty if not given
  /// The words of a value that is written: its type and the value, or the value alone.
  std::optional<std::string> first_word;
  std::optional<std::string> second_word;
  std::string file;
  std::size_t limit = most_file_bytes;
};

constexpr const char* value_examples = "6041, 1018:1 or statusword";
constexpr const char* file_examples = "1F50:1";

/// Refuses a word that can't be an object before the daemon or the bus is asked.
void check_object(const SdoOptions& options, const char* examples) {
  if (parse_object(options.object) || is_object_name(options.object)) return;
  throw Failure{"'" + options.object + "' is not an object like " + examples, 2};
}

DataType type_named(const std::string& word) {
  const auto type = parse_data_type(word);
  if (type) return *type;
  throw Failure{"'" + word + "' is not a type like u16, i32, f32, string, hex", 2};
}

/// Runs a transfer of this object. The sentence of a failure begins with node and object.
template <class Transfer>
auto transfer(const SdoOptions& options, const ChosenObject& object, const Transfer& run) {
  try {
    return run();
  } catch (const Failure& failure) {
    throw Failure{fmt::format("node {} {}: {}", options.node, object.text(), failure.what()),
                  failure.code};
  }
}

int read(const SdoOptions& options) {
  check_object(options, value_examples);
  auto type = options.type.empty() ? std::nullopt : std::optional{type_named(options.type)};
  SdoRoute route{options};
  const ChosenObject object = route.object(options.object, value_examples);
  if (!type && object.type != DataType::unknown) type = object.type;
  const SdoValue value = transfer(options, object, [&] {
    SdoValue bytes = route.upload(object.key);
    if (type && !fits(*type, bytes)) {
      const std::string word = options.type.empty() ? std::string{name(*type)} : options.type;
      throw Failure{misfit_text(word, *type, bytes), 1};
    }
    return bytes;
  });
  const std::string text = type ? value_text(*type, value) : untyped_text(value);
  if (options.live.json) {
    nlohmann::json json{{"node", route.node()},    {"index", object.key.index},
                        {"sub", object.key.sub},   {"size", value.size()},
                        {"data", hex_text(value)}, {"text", text}};
    if (!object.name.empty()) json["name"] = object.name;
    std::puts(json_text(json).c_str());
  } else {
    std::puts(printable_lines(text).c_str());
  }
  return 0;
}

int write(const SdoOptions& options) {
  check_object(options, value_examples);
  if (!options.first_word) throw Failure{"VALUE is required", 2};
  std::optional<SdoValue> value;
  if (options.second_word) {
    value = value_or_fail(value_bytes(type_named(*options.first_word), *options.second_word), 2);
  }
  SdoRoute route{options};
  const ChosenObject object = route.object(options.object, value_examples);
  if (!value) {
    const DataType type =
        object.type == DataType::unknown ? route.type_of(object.key) : object.type;
    if (type == DataType::unknown) {
      throw Failure{"the type of " + object.text() +
                        " is not known: write it before the value, for example u16",
                    2};
    }
    value = value_or_fail(value_bytes(type, *options.first_word), 2);
  }
  transfer(options, object, [&] { route.download(object.key, *value); });
  return 0;
}

int upload_file(const SdoOptions& options) {
  check_object(options, file_examples);
  SdoRoute route{options};
  const ChosenObject object = route.object(options.object, file_examples);
  const Interrupt interrupt;
  TransferProgress progress;
  const SdoValue value = transfer(options, object, [&] {
    return route.upload_file(object.key, options.limit,
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
  check_object(options, file_examples);
  const std::string content = value_or_fail(read_whole_file(options.file), 2);
  const auto bytes = std::as_bytes(std::span{content});
  SdoRoute route{options};
  const ChosenObject object = route.object(options.object, file_examples);
  const Interrupt interrupt;
  TransferProgress progress;
  transfer(options, object, [&] {
    route.download_file(object.key, {bytes.begin(), bytes.end()},
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
  verb.add_option("OBJ", options.object,
                  "object: its name, or index and sub-index in hex, 6041 or 1018:1")
      ->required();
  add_sdo_route(verb, options, "work directly on can0 or unix:PATH, without a daemon");
  return added;
}

}  // namespace

void add_sdo(CLI::App& app, int& exit_code) {
  auto* sdo = app.add_subcommand("sdo", "reads and writes objects of a device");
  sdo->require_subcommand(1);
  sdo->footer(
      "Examples:\n  takt sdo read shoulder statusword\n  takt sdo read 5 6041 u16\n"
      "  takt sdo write shoulder profile_velocity 1000\n  takt sdo write 5 6081 u32 1000\n"
      "  takt sdo read 5 vendor_id --bus can0 --eds drive.eds\n  takt sdo upload 5 1021 drive.eds "
      "--bus can0\n"
      "  takt sdo download 5 1F50:1 firmware.bin --timeout 10000\n"
      "Names are those of the EDS in small letters, as `takt od` lists them: statusword,\n"
      "identity_object.vendor_id; those of the second axis of a drive end in _2. The EDS also\n"
      "gives the type of the object. The daemon reports which EDS the network file names.\n"
      "Files have at most 16 MiB; Ctrl-C aborts a transfer on the bus.\n"
      "Types: bool, i8..i64, u8..u64, f32, f64, string, hex.");
  auto [reading, read_options] = add_verb(*sdo, exit_code, "read", "prints one value", read);
  reading.add_option("TYPE", read_options.type, "u16, i32, f32, string, hex ...");
  auto [writing, write_options] = add_verb(*sdo, exit_code, "write", "writes one value", write);
  writing.add_option("TYPE", write_options.first_word,
                     "u16, i32, f32, string, hex ...; may be left out if the device file tells it");
  writing.add_option("VALUE", write_options.second_word, "decimal, 0x hex, or text");
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
