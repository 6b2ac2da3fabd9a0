#include "apps/takt/demo/demo_files.hpp"

#include <system_error>

namespace takt {

std::expected<DemoFiles, std::string> find_demo_files(const std::filesystem::path& program) {
  const std::filesystem::path folder = program.parent_path();
  const DemoFiles files{.taktd = folder / "taktd",
                        .takt_move = folder / "takt-move",
                        .network = folder.parent_path() / "share/takt/demo/two_axes.yaml"};
  for (const auto* const file : {&files.taktd, &files.takt_move, &files.network}) {
    std::error_code ignored;
    if (std::filesystem::is_regular_file(*file, ignored)) continue;
    return std::unexpected{file->string() + " is missing; it belongs to " + program.string() +
                           ". Install all of takt, or build all of it"};
  }
  return files;
}

}  // namespace takt
