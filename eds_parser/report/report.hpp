#pragma once
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "eds_parser/report/message.hpp"
#include "eds_parser/report/source.hpp"

namespace takt {

/// Collects the findings of one file. Each rule may report `limit_per_rule` findings, so that the
/// report of a broken file of many megabytes stays bounded. The last finding of a rule says that
/// further ones were left out.
///
/// `rule` must be a string literal. The message is given in parts, see concat(). For a finding
/// beyond the limit the parts are not converted to text, which saves time.
class Report {
 public:
  static constexpr std::size_t limit_per_rule = 1000;

  explicit Report(std::string file) : file_{std::move(file)} {}

  template <class... Parts>
  void add(Severity severity, SourcePos pos, std::string_view rule, const Parts&... parts) {
    if (const std::size_t number = count(rule); number != 0) {
      findings_.push_back({file_, pos, severity, rule, concat(parts...)});
      if (number == limit_per_rule) findings_.back().message += further_left_out;
    }
  }
  template <class... Parts>
  void note(SourcePos pos, std::string_view rule, const Parts&... parts) {
    add(Severity::note, pos, rule, parts...);
  }
  template <class... Parts>
  void warning(SourcePos pos, std::string_view rule, const Parts&... parts) {
    add(Severity::warning, pos, rule, parts...);
  }
  template <class... Parts>
  void error(SourcePos pos, std::string_view rule, const Parts&... parts) {
    add(Severity::error, pos, rule, parts...);
  }

  /// Returns all findings in the order of their place in the file. The report is empty afterwards.
  Findings take();

 private:
  struct Count {
    std::string_view rule;
    std::size_t findings = 0;
  };

  static constexpr std::string_view further_left_out =
      " (further findings of this rule are left out)";

  /// Returns the number of the next finding of the rule, or 0 if the rule has reached its limit.
  std::size_t count(std::string_view rule);

  std::string file_;
  Findings findings_;
  std::vector<Count> counts_;
};

}  // namespace takt
