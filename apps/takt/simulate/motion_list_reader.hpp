#pragma once
#include <string>
#include <vector>
#include <yaml-cpp/yaml.h>

#include "apps/takt/simulate/entry_reader.hpp"
#include "apps/takt/simulate/motion/motion_script.hpp"
#include "eds_parser/table/bus_plan.hpp"

namespace takt {

/// Reads the list `motions:` of a fault file.
class MotionListReader {
 public:
  MotionListReader(EntryReader& reader, const BusPlan& plan);

  void read(const YAML::Node& list);
  bool is_empty() const noexcept { return scripts_.empty(); }
  MotionScripts take() { return std::move(scripts_); }

 private:
  void read_entry(const YAML::Node& entry);
  bool is_speed_axis(const std::string& axis) const;
  MotionScript* program_of(const YAML::Node& entry);
  std::vector<std::string> read_axes(const YAML::Node& list);
  void read_key(MotionEntry& motion, const EntryItem& item, const MotionScript& script);
  void read_expectation(MotionEntry& motion, const EntryItem& item);
  void check_time(const YAML::Node& entry, const MotionEntry& motion, const MotionScript& script);
  void read_gear(Gear& gear, const EntryItem& item, std::size_t axes);
  /// Reads one number, or one for each axis.
  Eigen::VectorXd read_numbers(const EntryItem& item, std::size_t axes);
  /// Reads one number for each axis. A single number applies to all axes.
  Eigen::VectorXd read_each(const EntryItem& item, std::size_t axes);
  void read_points(MotionEntry& motion, const EntryItem& item, std::size_t axes);
  void read_point(PathPoint& point, const EntryItem& item, std::size_t axes);

  EntryReader& reader_;
  std::vector<std::string> with_positions_;  // names of the axes of the bus
  std::vector<std::string> with_speeds_;
  std::vector<std::string> known_;  // names of both kinds
  MotionScripts scripts_;
};

}  // namespace takt
