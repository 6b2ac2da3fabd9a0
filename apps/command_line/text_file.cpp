#include "apps/command_line/text_file.hpp"

#include <fstream>
#include <iostream>
#include <sstream>
#include <system_error>
#include <utility>

namespace takt {

std::expected<std::string, std::string> read_whole_file(const std::filesystem::path& path) {
  std::error_code error;
  if (std::filesystem::is_directory(path, error)) {
    return std::unexpected{path.string() + ": is a directory"};
  }
  std::ifstream stream{path, std::ios::binary};
  std::ostringstream content;
  content << stream.rdbuf();
  if (!stream.is_open()) return std::unexpected{path.string() + ": cannot be read"};
  return std::move(content).str();
}

std::expected<void, std::string> write_whole_file(const std::filesystem::path& path,
                                                  std::string_view content) {
  if (path == "-") {
    std::cout << content << std::flush;
    return {};
  }
  auto part = path;
  part += ".part";
  std::error_code error;
  {
    std::ofstream stream{part, std::ios::binary};
    stream << content << std::flush;
    if (!stream) error = std::make_error_code(std::errc::io_error);
  }
  if (!error) std::filesystem::rename(part, path, error);
  if (!error) return {};
  std::error_code ignored;
  std::filesystem::remove(part, ignored);
  return std::unexpected{path.string() + ": cannot be written"};
}

}  // namespace takt
