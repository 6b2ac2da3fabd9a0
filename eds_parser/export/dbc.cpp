#include <optional>
#include <set>
#include <utility>
#include <vector>

#include "eds_parser/export/dbc_text.hpp"
#include "eds_parser/export/drive_words.hpp"
#include "eds_parser/export/export.hpp"
#include "eds_parser/report/message.hpp"

namespace takt {
namespace {

constexpr unsigned remote_bit = 9;  // bit of the statusword that needs special value texts

/// A signal in the terms of DBC.
struct DbcSignal {
  std::string name;
  unsigned start = 0;
  unsigned bits = 0;
  bool is_signed = false;
  double scale = 1.0;
  double offset = 0.0;
  std::string unit{};
  std::string multiplex{};  ///< "M", "m5"; empty = in every frame
};

class DbcWriter {
 public:
  DbcWriter(const BusPlan& plan, const DbcOptions& options) : plan_{plan}, options_{options} {
    std::set<std::string> used{"master", "Vector__XXX"};
    for (const auto& node : plan.nodes) nodes_.push_back(shorten(dbc_name(node.name), used));
  }

  std::string write() {
    write_head();
    write_services();
    for (const auto& row : plan_.pdos.tpdos) write_pdo(row, "TPDO");
    for (const auto& row : plan_.pdos.rpdos) write_pdo(row, "RPDO");
    out_ += '\n' + comments_ + attribute_definitions() + attributes_ + values_ + value_types_;
    return std::move(out_);
  }

 private:
  void write_head() {
    out_ = "VERSION \"\"\n\nNS_ :\n\nBS_:\n\nBU_: master";
    for (const auto& node : nodes_) out_ += ' ' + node;
    out_ += '\n';
  }

  void write_services() {
    if (plan_.cycle.sync) {
      const bool counted = plan_.cycle.sync_overflow != 0;
      begin_message(plan_.cycle.sync_cob_id, "SYNC", counted ? 1 : 0, "master", plan_.cycle.period);
      if (counted) write_signal({.name = "counter", .bits = 8}, every_node());
    }
    if (plan_.master_heartbeat != Time{}) {
      write_heartbeat(plan_.master_id, "master", plan_.master_heartbeat, every_node());
    }
    for (std::size_t i = 0; i < plan_.nodes.size(); ++i) {
      const auto& node = plan_.nodes[i];
      const auto& name = nodes_[i];
      begin_message(node.emcy_cob_id.value_or(CobId::base(0x080U + node.id.value())),
                    name + "_EMCY", 8, name, {});
      write_signal({.name = "error_code", .bits = 16}, "master");
      for (const auto& text : node.emcy_texts) error_text(text);
      end_values();
      write_signal({.name = "error_register", .start = 16, .bits = 8}, "master");
      write_signal({.name = "manufacturer", .start = 24, .bits = 40}, "master");
      write_heartbeat(node.id, name, node.heartbeat_period, "master");
    }
  }

  void write_heartbeat(NodeId id, const std::string& name, Time period,
                       const std::string& receivers) {
    begin_message(CobId::base(0x700U + id.value()), name + "_heartbeat", 1, name, period);
    write_signal({.name = "nmt_state", .bits = 8}, receivers);
    append(values_, "VAL_ ", id_,
           " nmt_state 0 \"boot-up\" 4 \"stopped\" 5 \"operational\" 127 \"pre-operational\" ;\n");
  }

  void error_text(const EmcyText& text) {
    if (texts_.empty()) texts_ = concat("VAL_ ", id_, " error_code");
    append(texts_, ' ', text.code, " \"", dbc_text(text.text), '"');
  }

  void end_values() {
    if (!texts_.empty()) values_ += texts_ + " ;\n";
    texts_.clear();
  }

  void write_pdo(const PdoRow& row, std::string_view kind) {
    const bool sent_by_node = kind == "TPDO";
    const auto& node = nodes_[row.node_index];
    const std::string receiver = sent_by_node ? "master" : node;
    if (!continues_mpdo(row)) {
      const bool cyclic = row.cyclic() && plan_.cycle.sync;
      begin_message(row.cob_id, concat(node, '_', kind, row.number), row.length,
                    sent_by_node ? node : "master",
                    cyclic ? plan_.cycle.period * row.transmission : row.event_timer);
      if (row.multiplexed()) {
        write_signal({.name = "object", .bits = 32, .multiplex = "M"}, receiver);
      }
    }
    multiplex_ = row.multiplexed() ? 'm' + std::to_string(row.header) : std::string{};
    for (const PdoField& field : plan_.pdos.fields_of(row)) write_field(field, receiver);
    multiplex_.clear();
  }

  /// Returns whether the row continues the previous MPDO. An MPDO has one row for each object, but
  /// is one message.
  bool continues_mpdo(const PdoRow& row) {
    const bool same = row.multiplexed() && mpdo_ == row.cob_id;
    mpdo_ = row.multiplexed() ? std::optional{row.cob_id} : std::nullopt;
    return same;
  }

  void write_field(const PdoField& field, const std::string& receiver) {
    const auto& signal = plan_.layout.signals[field.signal];
    const bool word = field.bits == 16 && plan_.nodes[signal.node_index].cia402 &&
                      (signal.object.index == 0x6041 || signal.object.index == 0x6040);
    if (word && options_.word_bits) return write_word(field, signal, receiver);
    write_signal({.name = signal.name,
                  .start = field.bit_offset,
                  .bits = field.bits,
                  .is_signed = field.sign_extend,
                  .scale = signal.scale,
                  .offset = signal.offset,
                  .unit = signal.unit,
                  .multiplex = multiplex_},
                 receiver);
    if (is_real(signal.type)) {
      append(value_types_, "SIG_VALTYPE_ ", id_, ' ', last_name_, " : ",
             signal.type == DataType::real32 ? "1" : "2", ";\n");
    }
    append(comments_, "CM_ SG_ ", id_, ' ', last_name_, " \"", signal.object, ' ', signal.type,
           "\";\n");
  }

  void write_word(const PdoField& field, const Signal& signal, const std::string& receiver) {
    const bool status = signal.object.index == 0x6041;
    const auto& names = status ? statusword_bits : controlword_bits;
    for (unsigned bit = 0; bit < names.size(); ++bit) {
      write_signal({.name = concat(signal.name, '_', names[bit]),
                    .start = field.bit_offset + bit,
                    .bits = 1,
                    .multiplex = multiplex_},
                   receiver);
      const bool stops = names[bit] == "quick_stop";  // active low
      append(values_, "VAL_ ", id_, ' ', last_name_,
             stops                         ? " 0 \"quick stop\" 1 \"no quick stop\" ;\n"
             : status && bit == remote_bit ? " 0 \"local\" 1 \"remote\" ;\n"
                                           : " 0 \"no\" 1 \"yes\" ;\n");
    }
  }

  void begin_message(CobId id, const std::string& name, unsigned length, const std::string& sender,
                     Time cycle) {
    id_ = std::to_string(id.is_extended() ? id.id() | 0x8000'0000U : id.id());
    names_.clear();
    full_names_.clear();
    const auto unique = shorten(name, message_names_);
    append(out_, "\nBO_ ", id_, ' ', unique, ": ", length, ' ', sender, '\n');
    if (unique != name) {
      append(attributes_, "BA_ \"SystemMessageLongSymbol\" BO_ ", id_, " \"", name, "\";\n");
    }
    const auto ms = std::chrono::round<std::chrono::milliseconds>(cycle).count();
    if (ms > 0) append(attributes_, "BA_ \"GenMsgCycleTime\" BO_ ", id_, ' ', ms, ";\n");
  }

  /// Makes a name unique in the message. An output that a PDO carries twice is one signal of the
  /// image but two signals of the message.
  std::string unique_in_message(const std::string& name) {
    std::string unique = name;
    for (unsigned n = 2; !full_names_.insert(unique).second; ++n) unique = concat(name, '_', n);
    return unique;
  }

  void write_signal(const DbcSignal& signal, const std::string& receivers) {
    const std::string name = unique_in_message(signal.name);
    last_name_ = shorten(name, names_);
    append(out_, " SG_ ", last_name_, signal.multiplex.empty() ? "" : " ", signal.multiplex, " : ",
           signal.start, '|', signal.bits, "@1", signal.is_signed ? '-' : '+', " (", signal.scale,
           ',', signal.offset, ") [0|0] \"", dbc_text(signal.unit), "\" ", receivers, '\n');
    if (last_name_ != name) {
      append(attributes_, "BA_ \"SystemSignalLongSymbol\" SG_ ", id_, ' ', last_name_, " \"", name,
             "\";\n");
    }
  }

  std::string every_node() const {
    std::string all;
    for (const auto& node : nodes_) all += (all.empty() ? "" : ",") + node;
    return all.empty() ? "Vector__XXX" : all;
  }

  static std::string attribute_definitions() {
    return "BA_DEF_ BO_ \"GenMsgCycleTime\" INT 0 65535;\n"
           "BA_DEF_ BO_ \"SystemMessageLongSymbol\" STRING ;\n"
           "BA_DEF_ SG_ \"SystemSignalLongSymbol\" STRING ;\n"
           "BA_DEF_DEF_ \"GenMsgCycleTime\" 0;\n"
           "BA_DEF_DEF_ \"SystemMessageLongSymbol\" \"\";\n"
           "BA_DEF_DEF_ \"SystemSignalLongSymbol\" \"\";\n";
  }

  const BusPlan& plan_;
  const DbcOptions& options_;
  std::vector<std::string> nodes_;  // names of the nodes, by node_index
  std::string out_;
  std::string comments_;
  std::string attributes_;
  std::string values_;
  std::string value_types_;
  std::string texts_;      // value texts of one EMCY message
  std::string id_;         // identifier of the current message
  std::string last_name_;  // name of its last signal
  std::string multiplex_;  // multiplexer of the signals of one MPDO object
  std::optional<CobId> mpdo_;
  std::set<std::string> message_names_;
  std::set<std::string> names_;       // names of the signals of one message
  std::set<std::string> full_names_;  // names of the signals of one message before shortening
};

}  // namespace

std::string to_dbc(const BusPlan& plan, const DbcOptions& options) {
  return DbcWriter{plan, options}.write();
}

}  // namespace takt
