#pragma once
#include <string>
#include <string_view>
#include <vector>

#include "eds_parser/source.hpp"

namespace takt {

/// Collects the findings of one file. Each rule may speak `limit_per_rule` times, so that a broken
/// file of many megabytes has a bounded report; the last one says that more were left out.
class Report {
 public:
  static constexpr std::size_t limit_per_rule = 1000;

  explicit Report(std::string file) : file_{std::move(file)} {}

  /// `rule` must be a string literal. False: the rule has already said enough, spare the message.
  bool wants(std::string_view rule) const noexcept;
  void note(SourcePos pos, std::string_view rule, std::string message);
  void warning(SourcePos pos, std::string_view rule, std::string message);
  void error(SourcePos pos, std::string_view rule, std::string message);

  const std::string& file() const noexcept { return file_; }
  /// All findings in order of their place in the file; the report is empty afterwards.
  Findings take();

 private:
  struct Count {
    std::string_view rule;
    std::size_t said = 0;
  };

  void add(SourcePos pos, Severity severity, std::string_view rule, std::string message);

  std::string file_;
  Findings findings_;
  std::vector<Count> counts_;
};

}  // namespace takt
