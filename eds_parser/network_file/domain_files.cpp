#include <algorithm>
#include <fstream>
#include <span>

#include "eds_parser/network_file/load_steps.hpp"
#include "eds_parser/report/network_report.hpp"
#include "eds_parser/report/text.hpp"

namespace takt {
namespace {

namespace fs = std::filesystem;

constexpr std::uintmax_t longest_file = std::uintmax_t{16} << 20U;
constexpr std::uint16_t first_program_object = 0x1F50;
constexpr std::uint16_t last_program_object = 0x1F57;

class Reader {
 public:
  Reader(const fs::path& dcf, const ObjectDictionary& dictionary, Findings& findings)
      : dcf_{dcf}, dictionary_{dictionary}, findings_{findings} {}

  void read(DomainFiles& files) {
    if (!files.upload.empty()) {
      announce(files, Severity::note, "upload-file", "UploadFile ", takt::quoted(files.upload),
               " is the file for what a tool reads from the device; taktd reads no files from "
               "devices (use `takt sdo upload`)");
    }
    if (!files.download.empty() && is_for_boot(files)) load(files);
  }

 private:
  template <class... Parts>
  void announce(const DomainFiles& files, Severity severity, std::string_view rule,
                const Parts&... what) {
    findings_.push_back(
        {dcf_.string(), files.pos, severity, rule, concat(files.key, ": ", what...)});
  }

  bool is_for_boot(const DomainFiles& files) {
    const SubObject* sub = dictionary_.find(files.key);
    if (sub == nullptr) return false;
    if (sub->type != DataType::domain || !sub->is_writable()) {
      announce(files, Severity::warning, "download-file", "DownloadFile ",
               takt::quoted(files.download),
               " belongs to an object that is not a writable DOMAIN; it was left out");
      return false;
    }
    const auto index = files.key.index;
    if (index >= first_program_object && index <= last_program_object) {
      announce(files, Severity::note, "download-file", "DownloadFile ",
               takt::quoted(files.download),
               " is a program: write `software_file` with `software_version`, and takt loads it if "
               "the device has another version");
      return false;
    }
    return true;
  }

  /// Replaces `\`, which tools for Windows write, by `/`.
  static fs::path relative(std::string name) {
    std::ranges::replace(name, '\\', '/');
    return name;
  }

  void load(DomainFiles& files) {
    const fs::path name = relative(files.download);
    const fs::path path = dcf_.parent_path() / name;
    std::error_code failed;
    const std::string what = "DownloadFile " + takt::quoted(files.download);
    if (name.is_absolute()) {
      return announce(files, Severity::error, "no-file", what,
                      " is an absolute path: put the file beside the DCF and write only its name");
    }
    if (!fs::is_regular_file(path, failed)) {
      return announce(files, Severity::error, "no-file", what, " not found; looked for ",
                      path.lexically_normal().string());
    }
    const auto size = fs::file_size(path, failed);
    if (failed || size == 0 || size > longest_file) {
      return announce(files, Severity::error, "no-file", what, " has ", failed ? 0 : size,
                      " bytes; 1 to ", longest_file, " can be downloaded");
    }
    std::vector<char> text(static_cast<std::size_t>(size));
    std::ifstream in{path, std::ios::binary};
    if (!in.read(text.data(), static_cast<std::streamsize>(text.size()))) {
      return announce(files, Severity::error, "no-file", what, " can't be read");
    }
    const auto bytes = std::as_bytes(std::span{text});
    files.content.assign(bytes.begin(), bytes.end());
  }

  const fs::path& dcf_;
  const ObjectDictionary& dictionary_;
  Findings& findings_;
};

}  // namespace

void read_domain_files(const fs::path& dcf, ObjectDictionary& dictionary, Findings& findings) {
  if (!dictionary.is_dcf) return;
  Reader reader{dcf, dictionary, findings};
  for (auto& files : dictionary.domain_files) reader.read(files);
}

}  // namespace takt
