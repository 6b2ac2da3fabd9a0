#pragma once
/// @file
/// The network file of a bus, compiled with its EDS files.
#include <chrono>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace takt {

/// One statement about a network file or about an EDS file that it names.
struct NetworkFinding {
  std::string file;          ///< path of the file
  std::uint32_t line = 0;    ///< counts from 1; 0 means the file as a whole
  std::uint32_t column = 0;  ///< counts from 1; 0 means the whole line
  bool error = false;        ///< true if the network can't be used; otherwise a warning or a note
  std::string_view rule;     ///< stable name of the rule, such as "unknown-key"
  std::string text;          ///< "file:line:column: severity: message [rule]"
};

/// One device of a bus.
struct NetworkNode {
  std::string name;        ///< from the network file: "shoulder"
  std::uint8_t id = 0;     ///< node-ID, 1..127
  std::string product;     ///< name of the product in its EDS file
  bool mandatory = false;  ///< `mandatory: true` of the network file
};

/// One value of the process image: an object that a PDO carries. SI value = raw * scale + offset.
struct ImageSignal {
  std::string node;          ///< name of its node
  std::uint8_t node_id = 0;  ///< node-ID, 1..127
  std::string name;          ///< EDS name in snake_case: "position_actual_value"
  std::uint16_t index = 0;   ///< index of the object, 0x6064
  std::uint8_t sub = 0;      ///< sub-index of the object
  std::uint8_t bits = 0;     ///< mapped length in bits, 1..64
  bool output = false;       ///< true: mapped into an RPDO, so that the master sends it
  double scale = 1.0;        ///< SI units for each count
  double offset = 0.0;       ///< SI value of 0 counts
  std::string unit;          ///< "rad", "rad/s"; empty means raw counts
};

/// A network file with all its EDS and DCF files, checked and compiled. The value does not change
/// after load(). `takt plan` prints everything that is compiled, in every detail.
class NetworkFile {
 public:
  /// Reads, checks and compiles a network file. The call returns a value even if the file has
  /// errors: usable() returns whether the network can be run, and findings() lists all errors,
  /// warnings and notes at once. Reads files and allocates.
  static NetworkFile load(const std::filesystem::path& path);

  ~NetworkFile();
  /// Moves the network; `other` may then only be destroyed or assigned to.
  NetworkFile(NetworkFile&& other) noexcept;
  /// Moves the network; `other` may then only be destroyed or assigned to.
  NetworkFile& operator=(NetworkFile&& other) noexcept;

  /// Returns true if no finding is an error.
  bool usable() const noexcept;
  /// Returns what load() found in the files.
  const std::vector<NetworkFinding>& findings() const noexcept;

  /// Returns the name of the bus: "lift".
  const std::string& bus() const noexcept;
  /// Returns the interface that the file names: "can0". Empty if it names none.
  const std::string& interface() const noexcept;
  /// Returns the period of SYNC, or that of the image if the bus has no SYNC.
  std::chrono::nanoseconds period() const noexcept;
  /// Returns the devices in ascending order of node-ID.
  const std::vector<NetworkNode>& nodes() const noexcept;
  /// Returns the values of the process image, in their order: the inputs, then the outputs.
  const std::vector<ImageSignal>& signals() const noexcept;
  /// Returns the position in signals() of an object that the device sends (TPDO). Empty if no TPDO
  /// of this node carries the object, or if there is no such node.
  std::optional<std::size_t> find_input(std::string_view node, std::uint16_t index,
                                        std::uint8_t sub = 0) const noexcept;
  /// Returns the position in signals() of an object that the master sends (RPDO). Empty if no RPDO
  /// of this node carries the object, or if there is no such node.
  std::optional<std::size_t> find_output(std::string_view node, std::uint16_t index,
                                         std::uint8_t sub = 0) const noexcept;

 private:
  friend class Master;
  struct State;
  explicit NetworkFile(std::unique_ptr<State> state) noexcept;

  std::unique_ptr<State> state_;
};

}  // namespace takt
