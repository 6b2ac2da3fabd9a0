#include "apps/takt/audit/audit_report.hpp"

#include <array>
#include <nlohmann/json.hpp>
#include <utility>

namespace takt {
namespace {

using Json = nlohmann::ordered_json;
using std::chrono::milliseconds;

constexpr std::array<const char*, 4> verdicts{"harmless", "stops", "untold", "goes_on"};
constexpr std::array<const char*, 4> colours{"", "\033[32m", "\033[33m", "\033[1;31m"};
constexpr std::array<const char*, 4> states{"pre-operational", "operational", "stopped", "untold"};

std::string ms_text(Time time) { return std::to_string(time / milliseconds{1}) + " ms"; }

std::string words(const NodeAudit& node) {
  using enum Failsafe;
  if (node.verdict == harmless) return "has no outputs";
  if (node.verdict == unspecified) {
    return "notices the loss of the master; the EDS does not say what the outputs do";
  }
  if (node.verdict == stops) {
    return (node.drive ? "stops" : "its outputs go to their error values") +
           (node.notices ? ", at the latest " + ms_text(*node.notices) + " later" : std::string{});
  }
  if (node.how.empty())
    return "KEEPS ITS LAST SET-POINTS: it does not notice the loss of the master";
  return "KEEPS ITS LAST SET-POINTS, although it notices the loss of the master";
}

std::string notice_text(const NodeAudit& node) {
  if (node.notices) return "noticed after " + ms_text(*node.notices) + ": " + node.how;
  if (!node.how.empty()) return "noticed when " + node.how;
  return "never noticed: the device watches neither heartbeat nor guarding of the master";
}

void line(std::ostream& out, const char* head, const std::string& text) {
  if (!text.empty()) out << "  " << head << text << '\n';
}

void print_remedy(std::ostream& out, const NodeAudit& node) {
  line(out, "remedy       ", node.master_remedy);
  if (node.remedy.empty()) return;
  out << "  remedy       in the network file:\n    " << node.name << ":\n";
  for (const std::string& text : node.remedy) out << "      " << text << '\n';
}

void print(std::ostream& out, const NodeAudit& node, Colour colour) {
  const bool coloured = colour == Colour::ansi;
  out << "node " << unsigned{node.id} << " " << node.name << (node.drive ? " (drive)" : "") << ": "
      << (coloured ? colours[std::to_underlying(node.verdict)] : "") << words(node)
      << (coloured ? "\033[0m" : "") << '\n';
  line(out, "master dies  ", notice_text(node));
  line(out, "  then       ", node.then);
  line(out, node.drive ? "  drive      " : "  outputs    ", node.outputs);
  line(out, "cable cut    ", "the same: the device receives nothing from the master");
  line(out, "bus-off      ", node.bus_off);
  for (const std::string& text : node.besides) line(out, "note         ", text);
  print_remedy(out, node);
}

Json json_of(const NodeAudit& node) {
  Json json{{"name", node.name},
            {"node_id", node.id},
            {"drive", node.drive},
            {"verdict", verdicts[std::to_underlying(node.verdict)]},
            {"text", words(node)}};
  json["notices_after_ms"] = node.notices ? Json(*node.notices / milliseconds{1}) : Json(nullptr);
  json["notices_by"] = node.how;
  json["error_state"] = states[std::to_underlying(node.state)];
  json["nmt"] = node.then;
  json["outputs"] = node.outputs;
  json["bus_off"] = node.bus_off;
  json["besides"] = node.besides;
  json["remedy"] = node.remedy;
  json["remedy_master"] = node.master_remedy;
  return json;
}

/// Returns how many devices have each verdict, for example "2 safe without the master, 1 that keep
/// their last set-points".
std::string summary(const Audit& audit) {
  std::array<unsigned, 4> count{};
  for (const NodeAudit& node : audit.nodes) ++count[std::to_underlying(node.verdict)];
  constexpr std::array<const char*, 4> texts{"without outputs", "safe without the master",
                                             "with a reaction that only the manual describes",
                                             "that keep their last set-points"};
  std::string text;
  for (std::size_t i = 0; i < count.size(); ++i) {
    if (count[i] == 0) continue;
    text += (text.empty() ? "" : ", ") + std::to_string(count[i]) + " " + texts[i];
  }
  return text;
}

}  // namespace

void print_audit(std::ostream& out, const Audit& audit, Colour colour) {
  out << "bus '" << audit.bus << "' without its master (node " << unsigned{audit.master_id} << ", ";
  out << (audit.heartbeat > Time{} ? "heartbeat every " + ms_text(audit.heartbeat)
                                   : "no heartbeat");
  out << "): " << summary(audit) << '\n'
      << (audit.asked ? "present values of the devices, read by SDO\n"
                      : "values after the boot, by EDS and network file\n");
  for (const NodeAudit& node : audit.nodes) {
    out << '\n';
    print(out, node, colour);
  }
}

void print_audit_json(std::ostream& out, const Audit& audit) {
  Json json{{"bus", audit.bus},
            {"master_id", audit.master_id},
            {"master_heartbeat_ms", audit.heartbeat / milliseconds{1}},
            {"asked", audit.asked},
            {"goes_on", audit.goes_on()}};
  json["nodes"] = Json::array();
  for (const NodeAudit& node : audit.nodes) json["nodes"].push_back(json_of(node));
  out << json.dump(1, ' ', false, Json::error_handler_t::replace) << '\n';
}

}  // namespace takt
