#pragma once
#include <expected>
#include <filesystem>
#include <string>
#include <string_view>

namespace takt {

/// Returns the content of the file. The error is a sentence with the file's name.
std::expected<std::string, std::string> read_whole_file(const std::filesystem::path& path);

/// Writes a temporary file and renames it, so that the target is never incomplete. `-` means
/// stdout. The error is a sentence with the file's name.
std::expected<void, std::string> write_whole_file(const std::filesystem::path& path,
                                                  std::string_view content);

}  // namespace takt
