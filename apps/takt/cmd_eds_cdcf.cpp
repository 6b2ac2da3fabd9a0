#include <CLI/CLI.hpp>
#include <iostream>
#include <memory>

#include "apps/command_line/commands.hpp"
#include "apps/command_line/failure.hpp"
#include "apps/command_line/finding_text.hpp"
#include "apps/command_line/live_arguments.hpp"
#include "apps/command_line/text_file.hpp"
#include "apps/command_line/whole_number.hpp"
#include "eds_parser/read/eds.hpp"
#include "eds_parser/write/configured_values.hpp"

namespace takt {
namespace {

struct EdsCdcfOptions {
  std::string file;
  std::string out;
  unsigned node = 0;
  bool decode = false;
};

std::string line_of(const ConciseEntry& entry) {
  std::string line = to_string(entry.object);
  for (const auto byte : entry.value) {
    line += ' ' + hex(std::to_integer<unsigned>(byte), 2).substr(2);
  }
  return line;
}

std::size_t size_of(const std::vector<ConciseEntry>& entries) {
  constexpr std::size_t count = 4;
  constexpr std::size_t head = 7;
  std::size_t size = count;
  for (const auto& entry : entries) size += head + entry.value.size();
  return size;
}

int print_concise(const EdsCdcfOptions& options) {
  const std::string content = value_or_fail(read_whole_file(options.file), 1);
  const auto entries = decode_concise_dcf(std::as_bytes(std::span{content}));
  if (!entries) return complain(options.file + ": the concise DCF " + entries.error(), 1);
  for (const auto& entry : *entries) std::cout << line_of(entry) << '\n';
  const auto used = size_of(*entries);
  if (content.size() > used) {
    complain(options.file + ": " + std::to_string(content.size() - used) +
                 " bytes follow the last of " + std::to_string(entries->size()) +
                 " entries; devices ignore these bytes",
             0);
  }
  return 0;
}

int write_concise(const EdsCdcfOptions& options) {
  const auto [entries, findings] =
      configured_values(read_eds_file(options.file, NodeId::from(options.node)));
  if (print_findings(findings, Severity::warning)) return 1;
  if (entries.empty()) {
    return complain(options.file + ": no object has a ParameterValue that can be written", 1);
  }
  const auto bytes = encode_concise_dcf(entries);
  value_or_fail(
      write_whole_file(options.out, {reinterpret_cast<const char*>(bytes.data()), bytes.size()}),
      1);
  return 0;
}

}  // namespace

void add_eds_cdcf(CLI::App& eds, int& exit_code) {
  auto options = std::make_shared<EdsCdcfOptions>();
  auto* command = eds.add_subcommand(
      "cdcf", "converts a DCF to a concise DCF (0x1F22), or prints a concise DCF");
  command->add_option("FILE", options->file, "DCF, or with --decode a concise DCF")->required();
  add_node_id(*command, options->node, "node id that replaces $NODEID");
  auto* out = command->add_option("-o,--output", options->out,
                                  "output file for the concise DCF; - for stdout");
  auto* decoding = command->add_flag("--decode", options->decode, "print a concise DCF as text");
  out->excludes(decoding);
  command->footer(
      "The concise DCF holds each ParameterValue of the DCF, in ascending order. Each PDO is one\n"
      "piece: invalid, mapping off, mapping, parameters, valid. After an error takt writes no\n"
      "file.\n\n"
      "Examples:\n"
      "  takt eds cdcf axis.dcf -o axis.bin\n"
      "  takt eds cdcf --decode axis.bin");
  command->callback([options, out, &exit_code] {
    if (!options->decode && out->empty()) throw CLI::RequiredError{"--output"};
    exit_code = options->decode ? print_concise(*options) : write_concise(*options);
  });
}

}  // namespace takt
