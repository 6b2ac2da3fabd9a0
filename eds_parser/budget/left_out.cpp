#include "eds_parser/budget/left_out.hpp"

namespace takt {

std::vector<std::string> left_out_tpdos(const Findings& findings) {
  std::vector<std::string> reported;
  for (const Finding& finding : findings) {
    const std::string_view pdos =
        std::string_view{finding.message}.substr(0, finding.message.find(" of node "));
    const bool tpdo = pdos.find("TPDO") != std::string_view::npos;
    if (finding.rule == "pdo-left-out" && tpdo)
      reported.push_back("not counted: " + finding.message);
  }
  return reported;
}

}  // namespace takt
