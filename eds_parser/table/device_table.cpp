#include "eds_parser/table/device_table.hpp"

#include "eds_parser/values/name_of.hpp"

namespace takt {

std::string_view access_name(Access access) noexcept {
  static constexpr std::string_view names[]{"ro", "wo", "rw", "rwr", "rww", "const"};
  return name_of(access, names, "rw");
}

}  // namespace takt
