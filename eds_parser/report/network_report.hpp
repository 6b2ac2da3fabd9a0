#pragma once
#include <cstddef>
#include <string>
#include <string_view>
#include <utility>

#include "eds_parser/report/message.hpp"
#include "eds_parser/report/source.hpp"

namespace takt {

/// Collects the findings of one network file, up to `max_findings`.
class NetworkReport {
 public:
  static constexpr std::size_t max_findings = 1000;

  NetworkReport(std::string file, Findings& findings)
      : file_{std::move(file)}, findings_{findings} {}

  // `parts` form the message, see concat().
  template <class... Parts>
  void error(SourcePos pos, std::string_view rule, const Parts&... parts) {
    ++errors_;
    add(pos, Severity::error, rule, concat(parts...));
  }
  template <class... Parts>
  void warning(SourcePos pos, std::string_view rule, const Parts&... parts) {
    add(pos, Severity::warning, rule, concat(parts...));
  }
  template <class... Parts>
  void note(SourcePos pos, std::string_view rule, const Parts&... parts) {
    add(pos, Severity::note, rule, concat(parts...));
  }
  const std::string& file() const noexcept { return file_; }
  /// Returns the number of errors so far. If it is higher after a part of the file was read, that
  /// part has errors.
  std::size_t errors() const noexcept { return errors_; }

 private:
  void add(SourcePos pos, Severity severity, std::string_view rule, std::string message) {
    if (findings_.size() < max_findings) {
      findings_.push_back({file_, pos, severity, rule, std::move(message)});
    } else if (findings_.size() == max_findings) {
      findings_.push_back({file_, pos, Severity::error, "too-many",
                           "there are more findings; correct these first"});
    }
  }

  std::string file_;
  Findings& findings_;
  std::size_t errors_ = 0;
};

}  // namespace takt
