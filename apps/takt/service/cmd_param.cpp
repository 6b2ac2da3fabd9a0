#include <CLI/CLI.hpp>
#include <chrono>
#include <cstdio>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>

#include "apps/command_line/commands.hpp"
#include "apps/command_line/json_text.hpp"
#include "apps/command_line/whole_number.hpp"
#include "apps/takt/live/daemon_client.hpp"
#include "master/wire/parameter_channel.hpp"

namespace takt {
namespace {

namespace channel = parameter_channel;

struct ParamOptions {
  LiveOptions live;
  std::string node;
  std::string parameter;
  std::string value;
  int pdo = 1;
  int timeout_ms = 500;
};

std::optional<std::uint32_t> number(std::string_view text, std::uint32_t most) {
  const auto value = parse_unsigned(text);
  return value && *value <= most ? value : std::nullopt;
}

/// Parses a parameter as `P15.13` (group and number, decimal) or as an address, `0x0F0D`.
std::optional<std::uint16_t> address_of(std::string_view text) {
  if (!text.starts_with('P') && !text.starts_with('p')) {
    const auto raw = number(text, 0xFFFF);
    return raw ? std::optional{static_cast<std::uint16_t>(*raw)} : std::nullopt;
  }
  const std::size_t dot = text.find('.');
  if (dot == std::string_view::npos) return {};
  const auto group = number(text.substr(1, dot - 1), 0xFF);
  const auto item = number(text.substr(dot + 1), 0xFF);
  if (!group || !item) return {};
  return static_cast<std::uint16_t>(*group << 8 | *item);
}

int print(const ParamOptions& options, std::uint16_t address, const channel::Answer& answer) {
  if (!answer.done) {
    return complain("the device refused " + options.parameter + ": error " +
                        std::to_string(answer.error) + ", " +
                        std::string{channel::error_text(answer.error)},
                    1);
  }
  if (options.live.json) {
    const nlohmann::json line{
        {"parameter", options.parameter}, {"address", address}, {"value", answer.value}};
    std::puts(json_text(line).c_str());
  } else if (options.value.empty()) {
    std::printf("%u\n", answer.value);
  }
  return 0;
}

request_t request_of(const ParamOptions& options, std::int16_t node, const channel::Bytes8& bytes) {
  request_t request = make_request("pdo_exchange", node);
  request.index = options.pdo;
  request.timeout_ms = options.timeout_ms;
  set_data(request, std::as_bytes(std::span{bytes}));
  return request;
}

int run(const ParamOptions& options, channel::Command command) {
  const auto address = address_of(options.parameter);
  if (!address) {
    return complain(
        "'" + options.parameter + "' is not a parameter like P15.13, or an address like 0x0F0D", 2);
  }
  const auto value =
      options.value.empty() ? std::optional<std::uint32_t>{0} : number(options.value, 0xFFFF'FFFF);
  if (!value) return complain("'" + options.value + "' is not a 32-bit number", 2);
  DaemonClient daemon = DaemonClient::find(options.live);
  const auto bytes = channel::request(command, *address, *value);
  const auto limit = std::chrono::milliseconds{options.timeout_ms} * 17 + std::chrono::seconds{2};
  const reply_t reply = daemon.demand(request_of(options, daemon.node(options.node), bytes), limit);
  const auto answer = channel::answer(reply.data);
  if (!answer) return complain("the answer of the device does not fit a parameter channel", 1);
  return print(options, *address, *answer);
}

}  // namespace

void add_param(CLI::App& app, int& exit_code) {
  auto* verb = app.add_subcommand(
      "param", "accesses drive parameters over a pair of PDOs (parameter channel)");
  verb->require_subcommand(1);
  verb->footer(
      "The network file must have `request: true` at RPDO1 and TPDO1 of the node.\nExamples:\n"
      "  takt param read pump P15.13\n  takt param write pump P15.13 1");
  for (const bool writes : {false, true}) {
    auto* way = verb->add_subcommand(writes ? "write" : "read",
                                     writes ? "sets a parameter" : "prints a parameter");
    auto options = std::make_shared<ParamOptions>();
    way->add_option("NODE", options->node, "node id or name")->required();
    way->add_option("PARAM", options->parameter, "P15.13, or the address 0x0F0D")->required();
    if (writes) way->add_option("VALUE", options->value, "number")->required();
    add_number(*way, "--pdo", options->pdo, "number of the pair of PDOs")
        ->check(CLI::Range(1, 512))
        ->capture_default_str();
    add_number(*way, "--timeout", options->timeout_ms, "longest wait for the answer, ms")
        ->check(CLI::Range(1, 60'000))
        ->capture_default_str();
    add_live_options(*way, options->live);
    way->callback([options, writes, &exit_code] {
      exit_code = run(*options, writes ? channel::Command::write : channel::Command::read);
    });
  }
}

}  // namespace takt
