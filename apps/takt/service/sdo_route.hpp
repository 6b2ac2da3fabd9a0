#pragma once
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "apps/takt/objects/chosen_object.hpp"
#include "apps/takt/objects/known_device.hpp"
#include "apps/takt/service/file_transfer.hpp"
#include "apps/takt/service/sdo_direct.hpp"

namespace takt {

/// The bytes of an object on the wire.
using SdoValue = std::vector<std::byte>;

/// The device of a command line, and how to reach it.
struct SdoRouteOptions {
  LiveOptions live;
  std::string bus;  ///< interface for direct access; empty means access through the daemon
  std::string node;
  int timeout_ms = 0;  ///< 0 means the time-out of the node
  DeviceFileOptions device_files;
};

/// Makes SDO transfers through the daemon or directly on the bus. A transfer that fails throws a
/// Failure.
class SdoRoute {
 public:
  /// `options` must outlive this object.
  explicit SdoRoute(const SdoRouteOptions& options);

  SdoValue upload(ObjectKey object);
  void download(ObjectKey object, const SdoValue& value);
  /// These functions transfer files, which may be long: in parts, by block transfer and with
  /// progress.
  SdoValue upload_file(ObjectKey object, std::size_t limit, const Progress& progress);
  void download_file(ObjectKey object, const SdoValue& value, const Progress& progress);
  int node() const noexcept { return node_; }
  /// Returns the data of the device from files and from the daemon. The first call reads them.
  const KnownDevice& device();
  /// Returns the object that the user means: by its index, or by its name. `examples` continues
  /// the sentence of the Failure if the word can be neither.
  ChosenObject object(const std::string& word, const char* examples);
  /// Returns the type of an object, or DataType::unknown if nothing describes it.
  DataType type_of(ObjectKey object) { return takt::type_of(device(), object); }

 private:
  reply_t ask(const char* service, ObjectKey object, const SdoValue& value);

  std::optional<SdoDirect> direct_;
  std::optional<DaemonClient> daemon_;
  std::optional<KnownDevice> device_;
  const SdoRouteOptions& options_;
  std::int16_t node_ = 0;
  int timeout_ms_;
};

}  // namespace takt
