#include "eds_parser/table/access_name.hpp"

namespace takt {

std::string_view access_name(Access access) noexcept {
  switch (access) {
    case Access::ro:
      return "ro";
    case Access::wo:
      return "wo";
    case Access::rw:
      return "rw";
    case Access::rwr:
      return "rwr";
    case Access::rww:
      return "rww";
    case Access::constant:
      return "const";
  }
  return "rw";
}

}  // namespace takt
