#pragma once
#include <expected>
#include <memory>
#include <string>

#include "apps/mcap/byte_sink.hpp"
#include "master/linux/file_descriptor.hpp"

namespace takt::logging {

/// The file of a log. Until commit() its name is `.part-NAME`, so that a file with the wanted name
/// is always complete. Stdout, pipes and devices are written directly.
class LogFile final : public mcap::ByteSink {
 public:
  /// Opens a file; `-` means stdout. The error is a sentence with the name of the file.
  static std::expected<std::unique_ptr<LogFile>, std::string> create(const std::string& path);
  /// Removes the file if commit() was not called.
  ~LogFile() override;

  bool reserve(std::uint64_t bytes) override;
  bool write(std::string_view bytes) override;
  /// Gives the file its final name. The error is a sentence with the name of the file.
  std::expected<void, std::string> commit();

  /// Returns the reason of the first failure of reserve() or write(), for example `No space left on
  /// device`. The text is empty if both have succeeded.
  const std::string& trouble() const noexcept { return trouble_; }
  const std::string& path() const noexcept { return path_; }
  std::uint64_t size() const noexcept { return size_; }

 private:
  LogFile(std::string path, std::string part, FileDescriptor file)
      : path_{std::move(path)}, part_{std::move(part)}, file_{std::move(file)} {}
  bool fail(int error);

  std::string path_;
  std::string part_;  // path of the file until commit(); empty for stdout, pipes and devices
  FileDescriptor file_;
  std::uint64_t size_ = 0;
  std::string trouble_;
};

}  // namespace takt::logging
