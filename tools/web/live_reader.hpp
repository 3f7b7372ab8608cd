// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <chrono>
#include <cstdint>
#include <optional>
#include <string>

#include "ipc/shared_memory.hpp"
#include "tools/web/action_desk.hpp"
#include "tools/web/live_state.hpp"
#include "tools/web/map_tiles.hpp"

namespace isobar::web {

/// Reads the running isobard and tells the viewers. Belongs to one thread; one per process, and one attachment per
/// process: the next isobard needs a new process.
class LiveReader {
 public:
  /// @param map_needed_for_s the map is asked for, at the cost of isobard, only while somebody watches and so long after
  static constexpr std::chrono::seconds kMapAfterViewer{30};

  /// Attaches.
  /// @throws ServiceError when no isobard runs, or this user may not attach to it
  LiveReader(LiveState& live, MapTiles& map, ActionDesk& desk);

  /// Takes what has come. Call it ten times a second.
  /// @param viewers pages that are open
  void poll(std::size_t viewers);
  /// False once that isobard has ended.
  [[nodiscard]] bool alive() const noexcept { return attachment_.broker_alive(); }

 private:
  using Clock = std::chrono::steady_clock;
  void take_poses();
  void take_health();
  void take_floors();
  void take_settings();
  void take_map(std::size_t viewers);
  void take_map_piece(const ipc::MapCloud& piece);
  void take_black_box();
  void follow_hint(const ipc::HealthReport& report);
  void carry_out_orders();
  /// An answer that does not come is said, too.
  void give_up_waiting();
  void tell_action(const std::string& text, bool failed);

  LiveState& live_;
  MapTiles& map_;
  ActionDesk& desk_;
  ipc::Attachment attachment_{"isobar-web", std::chrono::milliseconds(0)};
  ipc::Subscriber<PoseEstimate> poses_{ipc::topics::kPose};
  ipc::Subscriber<Prior> priors_{ipc::topics::kPrior};
  ipc::Subscriber<ipc::HealthReport> reports_{ipc::topics::kHealth};
  ipc::Subscriber<ipc::CurrentFloor> floor_{ipc::topics::kFloor};
  ipc::Subscriber<ipc::KnownFloors> known_floors_{ipc::topics::kKnownFloors};
  ipc::Subscriber<ipc::RunDescription> descriptions_{ipc::topics::kRunDescription};
  ipc::Subscriber<ipc::BlackBoxState> black_box_{ipc::topics::kBlackBoxState};
  ipc::Publisher<ipc::BlackBoxOrder> orders_{ipc::topics::kBlackBoxOrder};
  ipc::Publisher<ipc::PoseHint> hints_{ipc::topics::kPoseHint};
  std::optional<ipc::Subscriber<ipc::MapCloud>> clouds_;  ///< while somebody watches

  double altimeter_m_ = PoseRow::kUnknown;
  std::int64_t last_pose_ns_ = 0;
  std::uint32_t session_ = 0;  ///< of the poses; 0: none yet
  ipc::KnownFloors floors_;    ///< the newest
  std::optional<std::int32_t> current_floor_;

  std::optional<Clock::time_point> last_viewer_;
  std::optional<MapDraft> draft_;
  std::uint32_t draft_sequence_ = 0;
  std::uint32_t draft_points_ = 0;  ///< taken of the cloud so far
  std::uint32_t map_session_ = 0;

  std::uint64_t order_number_ = 0;  ///< of the order to the black box that waits for its answer; 0: none
  std::uint64_t hints_given_ = 0;   ///< as the health report counted them before ours
  bool hint_waits_ = false;
  Clock::time_point asked_{};  ///< of the newest action

  std::optional<Clock::time_point> last_report_;
};

}  // namespace isobar::web
