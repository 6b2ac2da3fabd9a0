#include <fmt/format.h>
#include <takt/motion.hpp>

#include "apps/axis/axes_program.hpp"
#include "apps/command_line/finding_text.hpp"
#include "apps/logic/logic_options.hpp"
#include "apps/logic/logic_run.hpp"
#include "eds_parser/network_file/yaml/yaml_tree.hpp"

namespace {

using takt::Obstacle;

std::unexpected<Obstacle> wrong_file(std::string text) {
  return std::unexpected{Obstacle{.kind = Obstacle::Kind::wrong_use, .text = std::move(text)}};
}

takt::Done run(const takt::LogicOptions& options) {
  const auto text = takt::read_limited_file(options.file);
  if (!text) return wrong_file("can't read " + options.file);
  takt::Findings findings;
  std::vector<takt::Rule> rules = takt::read_rules(*text, options.file, findings);
  if (takt::print_findings(findings))
    return wrong_file("no rule of " + options.file + " is run, because the file has errors");
  if (options.check) {
    for (const takt::Rule& rule : rules) fmt::print("{}\n", takt::rule_text(rule));
    return {};
  }
  auto group = takt::open_group(options.program);
  if (!group) return std::unexpected{group.error()};
  return takt::LogicRun{**group, options, std::move(rules), takt::program_interrupted}.run();
}

}  // namespace

int main(int argc, char** argv) {
  const auto [options, code] = takt::parse_logic(argc, argv);
  if (code) return *code;
  return takt::run_program(options.program.name, [&options] { return run(options); });
}
