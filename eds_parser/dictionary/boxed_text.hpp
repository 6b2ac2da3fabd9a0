#pragma once
#include <compare>
#include <memory>
#include <string>
#include <utility>

namespace takt {

/// A string that takes the space of one pointer, for a variant that rarely holds a string. Each
/// copy owns its string.
class BoxedText {
 public:
  BoxedText(std::string text) : text_{std::make_unique<std::string>(std::move(text))} {}
  BoxedText(const BoxedText& other) : BoxedText{other.text()} {}
  BoxedText(BoxedText&&) noexcept = default;
  BoxedText& operator=(const BoxedText& other) { return *this = BoxedText{other}; }
  BoxedText& operator=(BoxedText&&) noexcept = default;
  ~BoxedText() = default;

  const std::string& text() const noexcept { return *text_; }
  bool operator==(const BoxedText& other) const noexcept { return text() == other.text(); }
  auto operator<=>(const BoxedText& other) const noexcept { return text() <=> other.text(); }

 private:
  std::unique_ptr<std::string> text_;  ///< null only after a move
};

}  // namespace takt
