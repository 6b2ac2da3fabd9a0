#include <CLI/CLI.hpp>
#include <iostream>
#include <optional>

#include "apps/command_line/commands.hpp"
#include "apps/command_line/failure.hpp"
#include "apps/command_line/finding_text.hpp"
#include "apps/command_line/live_arguments.hpp"
#include "apps/command_line/text_file.hpp"
#include "eds_parser/ini/ini.hpp"
#include "eds_parser/report/text_diff.hpp"
#include "eds_parser/write/eds_fix.hpp"

namespace takt {
namespace {

struct EdsFixOptions {
  std::string file;
  std::string out;
  bool quiet = false;
};

/// Returns a UTF-16 file as UTF-8, so that people can read the difference. Returns std::nullopt if
/// the file is not UTF-16.
std::optional<std::string> recoded(const std::string& source) {
  Report ignored{""};
  const IniFile file = read_ini(source, ignored);
  if (!file.recoded) return std::nullopt;
  return *file.recoded;
}

/// Prints that the shown difference cannot be applied with `patch`.
void report_unpatchable(const EdsFixOptions& options) {
  std::cerr << options.file << ": the file is UTF-16 and becomes UTF-8; the difference shows only "
            << "the text and can't be applied with patch; "
            << (options.out.empty() ? "-o writes the corrected file\n"
                                    : "the output is complete\n");
}

int run(const EdsFixOptions& options) {
  const std::string source = value_or_fail(read_whole_file(options.file), 1);
  const FixedEds fixed = fix_eds(source, options.file);
  print_findings(fixed.left, options.quiet ? Severity::warning : Severity::note);
  if (!fixed.readable) return 1;
  const std::string name = options.out.empty() || options.out == "-" ? options.file : options.out;
  std::ostream& diff = options.out == "-" ? std::cerr : std::cout;
  const auto text = recoded(source);
  diff << unified_diff(text.value_or(source), fixed.text, options.file, name,
                       [](std::string_view line) { return line.starts_with('['); });
  if (text) report_unpatchable(options);
  std::cerr << options.file << ": " << fixed.fixed.size()
            << (fixed.fixed.size() == 1 ? " finding corrected, " : " findings corrected, ")
            << fixed.left.size() << " left\n";
  if (!options.out.empty()) value_or_fail(write_whole_file(options.out, fixed.text), 1);
  return has_error(fixed.left) ? 1 : 0;
}

}  // namespace

void add_eds_fix(CLI::App& eds, int& exit_code) {
  auto [command, options] = add_command<EdsFixOptions>(
      eds, exit_code, "fix", "corrects mistakes that can be read in only one way", run);
  command.add_option("FILE", options.file, "EDS or DCF")->required();
  command.add_option("-o,--output", options.out,
                     "corrected file; - for stdout; without -o takt only shows changes");
  command.add_flag("--quiet", options.quiet, "leave out notes about the remaining findings");
  std::string rules;
  for (const std::string_view rule : fixable_rules) {
    rules += (rules.empty() ? "" : rules.size() - rules.rfind('\n') > 75 ? ",\n" : ", ");
    rules += rule;
  }
  command.footer(
      "The difference goes to stdout in the form of diff -u, for `patch --binary`. (For a file in\n"
      "UTF-16, or with CR alone as line ends, the difference is only for reading.) The remaining\n"
      "findings go to stderr in the form of `takt eds check`. No object and no value changes into\n"
      "another one; all other text stays the same byte for byte. The exit code is 1 if an error\n"
      "remains. takt corrects the findings of these rules:\n" +
      rules +
      ",\nand misspellings of the keys ParameterName and DataType.\n\n"
      "Example:\n  takt eds fix drive.eds -o drive_fixed.eds");
}

}  // namespace takt
