#pragma once
#include <string>
#include <string_view>
#include <vector>

#include "eds_parser/report/source.hpp"

namespace takt {

/// Collects the findings of one file. Each rule may report `limit_per_rule` findings, so that the
/// report of a broken file of many megabytes stays bounded. The last finding of a rule says that
/// further ones were left out.
class Report {
 public:
  static constexpr std::size_t limit_per_rule = 1000;

  explicit Report(std::string file) : file_{std::move(file)} {}

  /// Returns false if the rule has reached its limit, so that the caller need not build the
  /// message. `rule` must be a string literal.
  bool wants(std::string_view rule) const noexcept;
  void note(SourcePos pos, std::string_view rule, std::string message);
  void warning(SourcePos pos, std::string_view rule, std::string message);
  void error(SourcePos pos, std::string_view rule, std::string message);

  const std::string& file() const noexcept { return file_; }
  /// Returns all findings in the order of their place in the file. The report is empty afterwards.
  Findings take();

 private:
  struct Count {
    std::string_view rule;
    std::size_t declared = 0;
  };

  void add(SourcePos pos, Severity severity, std::string_view rule, std::string message);

  std::string file_;
  Findings findings_;
  std::vector<Count> counts_;
};

}  // namespace takt
