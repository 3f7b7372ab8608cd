// SPDX-License-Identifier: BSD-3-Clause
// DDS outputs about floors: the occupancy grid and which floor the robot is on.
#pragma once

#include <dds/dds.h>

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "ipc/dds/endpoints.hpp"
#include "ipc/dds/grid_assembly.hpp"
#include "ipc/dds_config.hpp"
#include "ipc/topics.hpp"

namespace isobar::dds {

/// map, floor and floor_name, see Writer and the table of topics. A writer is made with the first message that it writes:
/// a topic that nobody fills would keep a navigation waiting for its first message. The newest grid and floor are kept,
/// and written anew after each open(). One thread at a time.
class FloorOutputs {
 public:
  explicit FloorOutputs(const DdsConfig& config) : config_(config) {}
  FloorOutputs(const FloorOutputs&) = delete;
  FloorOutputs& operator=(const FloorOutputs&) = delete;

  /// Takes other settings while closed.
  void configure(const DdsConfig& config) { config_ = config; }
  /// Writes what is kept.
  /// @throws ServiceError when a DDS entity cannot be created
  void open(dds_entity_t participant);
  void close() noexcept;

  /// Takes a piece of a grid; publishes the grid, in the map frame, with its last piece.
  /// @param shift_ns see PoseOutputs::set_stamp_shift_ns()
  /// @throws ServiceError when a DDS entity cannot be created
  void on_grid(const ipc::FloorGrid& piece, std::int64_t shift_ns);
  /// Publishes number and name of the floor when they change. A floor that is not known is no message: what was said
  /// last stays, and the diagnostics say how sure it is.
  /// @throws ServiceError when a DDS entity cannot be created
  void on_floor(const ipc::CurrentFloor& floor);

  /// Writers there are; their number grows with the first messages.
  [[nodiscard]] std::vector<dds_entity_t> writers() const;
  [[nodiscard]] std::uint64_t failures() const noexcept;
  /// See GridAssembly::refused().
  [[nodiscard]] std::uint64_t refused() const noexcept { return grid_.refused() + floors_refused_; }

 private:
  void write_grid();
  void write_floor();
  template <class Message>
  void write(std::optional<Writer<Message>>& writer, const DdsTopic<Message>& topic, const std::string& name,
             const Message& message);

  DdsConfig config_;
  GridAssembly grid_;
  std::int64_t grid_shift_ns_ = 0;
  std::optional<std::int32_t> number_;  ///< of the last known floor
  std::string name_;
  std::uint64_t floors_refused_ = 0;  ///< messages about floors whose name does not end
  dds_entity_t participant_ = 0;      ///< 0: closed
  std::optional<Writer<GridMessage>> map_;
  std::optional<Writer<Int32Message>> floor_;
  std::optional<Writer<StringMessage>> floor_name_;
};

}  // namespace isobar::dds
