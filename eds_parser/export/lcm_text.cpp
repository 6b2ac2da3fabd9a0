#include <algorithm>

#include "eds_parser/export/export.hpp"
#include "eds_parser/report/message.hpp"

namespace takt {

std::string to_lcm(const TypedMessage& message, const BusPlan& plan) {
  const NodePlan& node = plan.nodes[message.node_index];
  std::string out =
      concat("package ", message.package, ";\n\n",
             message.command ? "// Set-points for the outputs of node " : "// Inputs of node ",
             node.id.value(), ' ', node.name, " of bus ", plan.name,
             ". Made by takt export lcm.\n// Fingerprint ", hex64(message.fingerprint()),
             ".\nstruct ", message.name, "\n{\n");
  std::size_t widest = 0;
  for (const TypedField& field : message.fields) widest = std::max(widest, field.name.size());
  for (const TypedField& field : message.fields) {
    std::string type{name(field.type)};
    type.resize(8, ' ');
    append(out, "    ", type, field.name, ';', std::string(widest - field.name.size() + 2, ' '),
           "// ", field.comment, '\n');
  }
  return out + "}\n";
}

}  // namespace takt
