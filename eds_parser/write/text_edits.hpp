#pragma once
#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

namespace takt {

/// A set of changes to a text. All other text stays byte for byte. New lines have the same
/// line end as those of the text.
class TextEdits {
 public:
  explicit TextEdits(std::string_view text);

  /// Replaces `part`. `part`, and `anchor` below, are views into the text. If two edits affect the
  /// same place, the first one counts.
  void replace(std::string_view part, std::string with);
  /// Adds a line behind the line that holds `anchor`. Lines added behind the same line keep their
  /// order.
  void insert_line_after(std::string_view anchor, std::string_view line);
  void append_line(std::string_view line);
  bool any() const noexcept { return !edits_.empty(); }
  std::string apply() &&;

 private:
  struct Edit {
    std::size_t at = 0;
    std::size_t length = 0;
    std::string with;
    bool is_line = false;
  };

  std::size_t offset(std::string_view part) const noexcept {
    return static_cast<std::size_t>(part.data() - text_.data());
  }
  void add_line(std::size_t at, std::string_view line);

  std::string_view text_;
  std::string_view line_end_ = "\n";
  std::vector<Edit> edits_;
};

}  // namespace takt
