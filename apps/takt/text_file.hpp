#pragma once
#include <expected>
#include <filesystem>
#include <string>
#include <string_view>

namespace takt {

/// The whole file; an error is a sentence with the file's name.
std::expected<std::string, std::string> read_whole_file(const std::filesystem::path& path);

/// Writes beside the file and renames, so that there is never half a file; `-` is stdout.
/// An error is a sentence with the file's name.
std::expected<void, std::string> write_whole_file(const std::filesystem::path& path,
                                                  std::string_view content);

}  // namespace takt
