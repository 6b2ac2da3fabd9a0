#pragma once
#include <deque>
#include <ios>
#include <optional>
#include <sstream>
#include <string>
#include <string_view>
#include <vector>

#include "eds_parser/network_file/keys/read_network.hpp"
#include "eds_parser/plan/network_compiler.hpp"
#include "eds_parser/read/eds.hpp"

namespace takt::test {

/// Makes one [section] of an EDS: a VAR, or a sub-object if `section` names one.
inline std::string entry(std::string_view section, std::string_view name, int type,
                         std::string_view access, std::string_view value, bool mappable = false) {
  std::ostringstream out;
  out << '[' << section << "]\nParameterName=" << name << "\nObjectType=0x7\nDataType=0x000" << type
      << "\nAccessType=" << access << "\nDefaultValue=" << value << "\nPDOMapping=" << mappable
      << "\n";
  return out.str();
}

inline std::string record(std::string_view section, std::string_view name, int subs) {
  std::ostringstream out;
  out << '[' << section << "]\nParameterName=" << name << "\nObjectType=0x9\nSubNumber=" << subs
      << "\n";
  return out.str();
}

/// Makes the communication and mapping records of PDO `number`; `cob_id` and `entries` are texts as
/// in an EDS.
inline std::string pdo(bool is_tpdo, int number, std::string_view cob_id, int transmission,
                       std::vector<std::string> entries, std::string_view mapping_access = "rw") {
  const auto at = [&](int first, std::string_view sub) {
    std::ostringstream out;
    out << std::hex << std::uppercase << first + number - 1 << sub;
    return out.str();
  };
  const int comm = is_tpdo ? 0x1800 : 0x1400;
  std::string text = record(at(comm, ""), "communication", is_tpdo ? 6 : 4) +
                     entry(at(comm, "sub0"), "highest", 5, "const", is_tpdo ? "6" : "5") +
                     entry(at(comm, "sub1"), "COB-ID", 7, "rw", cob_id) +
                     entry(at(comm, "sub2"), "type", 5, "rw", std::to_string(transmission)) +
                     entry(at(comm, "sub5"), "event timer", 6, "rw", "0");
  if (is_tpdo) {
    text += entry(at(comm, "sub3"), "inhibit time", 6, "rw", "0") +
            entry(at(comm, "sub6"), "SYNC start value", 5, "rw", "0");
  }
  const std::size_t count = entries.size();
  entries.resize(8, "0");
  text += record(at(comm + 0x200, ""), "mapping", 9) +
          entry(at(comm + 0x200, "sub0"), "count", 5, mapping_access, std::to_string(count));
  for (std::size_t i = 0; i < entries.size(); ++i) {
    text += entry(at(comm + 0x200, "sub" + std::to_string(i + 1)), "entry", 7, mapping_access,
                  entries[i]);
  }
  return text;
}

/// Makes the objects that most tests need: a CiA 402 drive, with one object for each kind of
/// problem from 2000 on.
inline std::string tiny_objects() {
  return "[DeviceInfo]\nProductName=tiny\nBaudRate_500=1\nBaudRate_1000=1\nGranularity=8\n"
         "[DummyUsage]\nDummy0001=0\nDummy0005=1\nDummy0006=0\n" +
         entry("1000", "Device type", 7, "ro", "0x00020192") +
         entry("1001", "Error register", 5, "ro", "0", true) +
         entry("1005", "COB-ID SYNC", 7, "rw", "0x80") +
         entry("1006", "Cycle period", 7, "rw", "0") + entry("1007", "Window", 7, "rw", "0") +
         entry("1019", "Counter", 5, "rw", "0") + record("1016", "Consumer heartbeat", 2) +
         entry("1016sub0", "highest", 5, "const", "1") + entry("1016sub1", "entry", 7, "rw", "0") +
         entry("1017", "Heartbeat", 6, "rw", "0") + record("1018", "Identity", 3) +
         entry("1018sub0", "highest", 5, "const", "2") +
         entry("1018sub1", "Vendor-ID", 7, "ro", "0x0000ABCD") +
         entry("1018sub2", "Product code", 7, "ro", "0x402") +
         entry("6040", "Controlword", 6, "rww", "0", true) +
         entry("6041", "Statusword", 6, "ro", "0", true) +
         entry("6060", "Modes of operation", 2, "rww", "0", true) +
         entry("6061", "Modes of operation display", 2, "ro", "0", true) +
         entry("6064", "Position actual value", 4, "ro", "0", true) +
         entry("606C", "Velocity actual value", 4, "ro", "0", true) +
         entry("607A", "Target position", 4, "rww", "0", true) +
         entry("6081", "Profile velocity", 7, "rw", "1000", true) +
         entry("60FF", "Target velocity", 4, "rww", "0", true) +
         record("60C2", "Interpolation", 3) + entry("60C2sub0", "highest", 5, "const", "2") +
         entry("60C2sub1", "Period value", 5, "rw", "1") +
         entry("60C2sub2", "Period index", 2, "rw", "-3") +
         entry("2000", "Not mappable", 6, "rw", "0") +
         entry("2001", "Write only", 6, "wo", "0", true) + entry("2002", "Text", 9, "rw", "abc") +
         entry("2003", "Wide", 7, "rw", "0", true) + entry("2004", "Wider", 7, "rw", "0", true);
}

/// Makes the EDS of the tiny drive: RPDO1 with 6040 and TPDO1 with 6041 are enabled; RPDO2 and
/// TPDO2..5 are disabled.
inline std::string tiny_eds() {
  return tiny_objects() + pdo(false, 1, "$NODEID+0x200", 1, {"0x60400010"}) +
         pdo(false, 2, "$NODEID+0x80000300", 1, {"0x60400010", "0x607A0020"}) +
         pdo(true, 1, "$NODEID+0x40000180", 1, {"0x60410010"}) +
         pdo(true, 2, "$NODEID+0xC0000280", 255, {"0x60640020"}) +
         pdo(true, 3, "0x80000000", 255, {}) + pdo(true, 4, "0x80000000", 255, {}) +
         pdo(true, 5, "0x80000000", 255, {});
}

struct Compiled {
  NetworkSpec spec;
  BusPlan plan;
  std::vector<DeviceTable> devices;
  Findings findings;

  /// Returns `line:column severity [rule]` for the errors and warnings of the network file.
  /// Questions about drives (`mode`, `on-loss`) are left out: careful_questions_test.cpp has their
  /// tests.
  std::vector<std::string> complaints() const {
    std::vector<std::string> out;
    for (const Finding& f : findings) {
      if (f.file != "net.yaml" || f.severity == Severity::note) continue;
      if (f.rule == "mode" || f.rule == "on-loss") continue;
      out.push_back(std::to_string(f.pos.line) + ":" + std::to_string(f.pos.column) + " " +
                    std::string{name(f.severity)} + " [" + std::string{f.rule} + "]");
    }
    return out;
  }
  /// Returns all messages of one rule.
  std::string declared(std::string_view rule) const {
    std::string out;
    for (const Finding& f : findings) {
      if (f.rule == rule) out += f.message + "\n";
    }
    return out;
  }
};

/// Compiles a network file whose nodes all have the device of `eds`.
inline Compiled compile(std::string_view yaml, const std::string& eds = tiny_eds(),
                        const std::string& file = "tiny.eds") {
  Compiled out;
  out.spec = read_network(yaml, "net.yaml", out.findings);
  std::deque<EdsFile> files;
  std::vector<const ObjectDictionary*> dictionaries;
  for (const NodeSpec& node : out.spec.nodes) {
    files.push_back(read_eds(eds, file, NodeId::from(*node.id)));
    dictionaries.push_back(&files.back().dictionary);
  }
  CompiledNetwork compiled = compile_network(out.spec, dictionaries, out.findings);
  out.plan = std::move(compiled.plan);
  out.devices = std::move(compiled.devices);
  return out;
}

/// Makes a network file with the node `arm`, node-ID 5, on line 2; `pdos` starts on line 3.
inline std::string arm_with(std::string_view pdos) {
  return "master: {sync_period: 10000}\narm: {node_id: 5, dcf: tiny.eds,\n" + std::string{pdos} +
         "}\n";
}

}  // namespace takt::test
