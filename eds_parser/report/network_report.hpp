#pragma once
#include <concepts>
#include <cstddef>
#include <string>
#include <string_view>
#include <utility>

#include "eds_parser/report/source.hpp"

namespace takt {

/// Returns one part of a message as text. A text stays as it is, and a number is written in
/// decimal.
inline std::string_view message_part(std::string_view text) noexcept { return text; }
inline std::string message_part(std::integral auto number) { return std::to_string(number); }
template <class T>
  requires requires(const T& value) { to_string(value); }
std::string message_part(const T& value) {
  return to_string(value);
}

/// Returns the parts as one text. Each part is a text, a number, or a value with a to_string().
template <class... Parts>
std::string joined(const Parts&... parts) {
  std::string text;
  ((text += message_part(parts)), ...);
  return text;
}

/// Collects the findings of one network file, up to `max_findings`.
class NetworkReport {
 public:
  static constexpr std::size_t max_findings = 1000;

  NetworkReport(std::string file, Findings& findings)
      : file_{std::move(file)}, findings_{findings} {}

  // `parts` form the message, see joined().
  template <class... Parts>
  void error(SourcePos pos, std::string_view rule, const Parts&... parts) {
    ++errors_;
    add(pos, Severity::error, rule, joined(parts...));
  }
  template <class... Parts>
  void warning(SourcePos pos, std::string_view rule, const Parts&... parts) {
    add(pos, Severity::warning, rule, joined(parts...));
  }
  template <class... Parts>
  void note(SourcePos pos, std::string_view rule, const Parts&... parts) {
    add(pos, Severity::note, rule, joined(parts...));
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
