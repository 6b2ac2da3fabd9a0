#pragma once
#include <compare>
#include <memory>
#include <string>

namespace takt {

/// A string in the room of one pointer, for places of which few hold one. A copy is its own string.
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
  std::unique_ptr<std::string> text_;  ///< null only where it was moved from
};

}  // namespace takt
