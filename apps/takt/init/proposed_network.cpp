#include "apps/takt/init/proposed_network.hpp"

#include <algorithm>
#include <cctype>
#include <fmt/format.h>
#include <map>
#include <system_error>
#include <unistd.h>
#include <utility>

#include "apps/command_line/failure.hpp"
#include "apps/command_line/text_file.hpp"
#include "apps/takt/learn/yaml_text.hpp"
#include "eds_parser/budget/budget.hpp"
#include "eds_parser/network_file/load_network.hpp"

namespace takt::init {
namespace {

namespace fs = std::filesystem;

constexpr std::uint32_t periods_us[] = {1000, 2000, 4000, 5000, 10'000, 20'000, 50'000, 100'000};
/// The period of SYNC for the trial of a single device. It is long enough for all frames of the
/// device.
constexpr std::uint32_t patient_period_us = 100'000;
constexpr double most_load = 0.6;
constexpr std::uint8_t usual_master = 127;

/// Reads the text of a network file as taktd would read it from a file in the same folder.
class Trial {
 public:
  explicit Trial(const fs::path& file)
      : path_{file.parent_path() / fmt::format(".{}.{}.yaml", file.stem().string(), ::getpid())} {}
  ~Trial() {
    std::error_code ignored;
    fs::remove(path_, ignored);
  }
  Trial(const Trial&) = delete;
  Trial& operator=(const Trial&) = delete;

  LoadedNetwork load(const std::string& text) const {
    value_or_fail(write_whole_file(path_, text), exit_wrong_use);
    return load_network(path_);
  }

 private:
  fs::path path_;
};

const Finding* first_error(const Findings& findings) {
  const auto found = std::ranges::find(findings, Severity::error, &Finding::severity);
  return found == findings.end() ? nullptr : &*found;
}

/// Returns a name for the bus, made from the name of the file: letters, digits and underscores.
std::string bus_name(const fs::path& file) {
  std::string name = file.stem().string();
  std::ranges::replace_if(
      name, [](char c) { return std::isalnum(static_cast<unsigned char>(c)) == 0; }, '_');
  const bool good = !name.empty() && std::isalpha(static_cast<unsigned char>(name[0])) != 0;
  return good ? name : "machine";
}

class Proposer {
 public:
  Proposer(const std::vector<DeviceToWrite>& devices, const InitFacts& facts)
      : devices_{devices}, facts_{facts}, trial_{facts.file} {}

  ProposedNetwork run() {
    for (const DeviceToWrite& device : devices_) choose_detail(device);
    choose_period();
    propose_limits();
    out_.text = text(out_.period_us);
    return std::move(out_);
  }

 private:
  /// Finds the most detailed entry of a device that taktd accepts together with the entries before.
  void choose_detail(const DeviceToWrite& device) {
    if (!device.found.file.dictionary) {
      reasons_[device.found.id] =
          device.found.node.answers
              ? "No device file of --eds-dir fits it: ask the manufacturer for its EDS, then write"
              : "It sends a heartbeat, but does not answer SDO requests. With its EDS, write";
      ++out_.missing;
      return;
    }
    std::string why;
    for (const Detail detail : {Detail::whole, Detail::own_pdos, Detail::file_only}) {
      const LoadedNetwork network = trial_.load(head(patient_period_us) + "nodes:\n" + accepted_ +
                                                device_entry(device, detail, {}));
      const Finding* const error = first_error(network.findings);
      if (error == nullptr) {
        details_[device.found.id] = detail;
        accepted_ += device_entry(device, detail, {});
        return;
      }
      if (why.empty()) why = error->message;
    }
    reasons_[device.found.id] = "taktd does not accept it with " + device.file + ": " + why;
    ++out_.missing;
  }

  void choose_period() {
    for (const std::uint32_t period : periods_us) {
      const LoadedNetwork network = trial_.load(text(period));
      if (first_error(network.findings) != nullptr) {
        too_short_ = period;
        continue;
      }
      const BusBudget budget = bus_budget(network.plan);
      out_.period_us = period;
      load_ = budget.load.worst;
      if (budget.fits() && budget.load.worst <= most_load) return;
      too_short_ = period;
    }
    if (out_.period_us == 0) out_.period_us = patient_period_us;
    out_.too_slow = true;
  }

  /// Takes the limits that the plan proposes. They are left out if taktd does not accept them.
  void propose_limits() {
    const LoadedNetwork network = trial_.load(text(out_.period_us));
    if (first_error(network.findings) != nullptr) return;
    for (const LimitLine& line : network.plan.limits.lines) {
      const std::uint8_t id = network.plan.nodes[line.node_index].id.value();
      if (line.axis > 1 || line.kind == LimitKind::step) continue;
      if (line.source == LimitSource::device) {
        limits_[id].push_back({std::string{name(line.kind)} + ": ...",
                               "without it, " + to_string(line.object) +
                                   " of the device applies, which takt reads in each boot"});
      } else if (line.source == LimitSource::none && !line.proposal.empty()) {
        limits_[id].push_back({line.proposal, line.because});
      }
    }
    if (first_error(trial_.load(text(out_.period_us)).findings) != nullptr) limits_.clear();
  }

  std::uint8_t master_id() const {
    std::uint8_t id = usual_master;
    const auto is_taken = [&](const DeviceToWrite& device) { return device.found.id == id; };
    while (id > 1 && std::ranges::any_of(devices_, is_taken)) --id;
    return id;
  }

  std::string period_comment(std::uint32_t period) const {
    if (load_ == 0.0 || period != out_.period_us) return "us";
    std::string comment = fmt::format("us; process data fill {:.0f} % of the bus", 100 * load_);
    if (too_short_ != 0 && too_short_ < period) {
      comment += fmt::format(", {} us would leave too little room", too_short_);
    }
    return comment;
  }

  std::string head(std::uint32_t period) const {
    return fmt::format(
        "# Proposed by `takt init` from a scan of {}: {} device{}, {} of them with an entry.\n"
        "# Read it, check the units and limits, and look at `takt plan` before the first start.\n"
        "bus: {{name: {}, interface: {}, bitrate_kbit: {}}}{}\n\n"
        "master:\n"
        "  node_id: {}\n"
        "  sync_period: {}  # {}\n"
        "  heartbeat_producer: 100  # ms\n\n",
        facts_.interface, devices_.size(), devices_.size() == 1 ? "" : "s",
        devices_.size() - out_.missing, bus_name(facts_.file), learn::yaml_word(facts_.interface),
        facts_.bitrate_kbit, facts_.bitrate_source.empty() ? "" : "   # " + facts_.bitrate_source,
        master_id(), period, period_comment(period));
  }

  std::string text(std::uint32_t period) const {
    std::string all = head(period);
    all += details_.empty() ? "nodes: {}\n" : "nodes:\n";
    for (const DeviceToWrite& device : devices_) {
      const auto detail = details_.find(device.found.id);
      if (detail == details_.end()) {
        all += missing_entry(device, reasons_.at(device.found.id));
        continue;
      }
      const auto limits = limits_.find(device.found.id);
      all += device_entry(device, detail->second,
                          limits == limits_.end() ? std::vector<ProposedLimit>{} : limits->second);
    }
    return all;
  }

  const std::vector<DeviceToWrite>& devices_;
  const InitFacts& facts_;
  Trial trial_;
  ProposedNetwork out_;
  double load_ = 0.0;
  std::uint32_t too_short_ = 0;  // longest period that leaves too little room, us; 0 = none
  std::string accepted_;         // accepted entries of the devices before
  std::map<std::uint8_t, Detail> details_;
  std::map<std::uint8_t, std::string> reasons_;  // reasons why devices have no entry
  std::map<std::uint8_t, std::vector<ProposedLimit>> limits_;
};

}  // namespace

ProposedNetwork proposed_network(const std::vector<DeviceToWrite>& devices,
                                 const InitFacts& facts) {
  return Proposer{devices, facts}.run();
}

}  // namespace takt::init
