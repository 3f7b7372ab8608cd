// SPDX-License-Identifier: BSD-3-Clause
#include "daemon/place_thread.hpp"

#include <spdlog/spdlog.h>

#include <exception>
#include <utility>

#include "daemon/message_loop.hpp"

namespace isobar {

namespace {

std::shared_ptr<const KnownMap> read_map(const MapStores& maps, std::uint32_t session) {
  if (!maps.configured() && !maps.read_only()) return nullptr;
  try {
    const auto store = FileTileStore::open_to_read(maps.folder_of(session));
    return read_known_map(*store, session);
  } catch (const std::exception& error) {
    spdlog::error("the map in which the place is searched cannot be read: {}", error.what());
    return nullptr;
  }
}

}  // namespace

PlaceThread::PlaceThread(const StageSettings& settings, const RunFiles& files, MapThread& map,
                         RegistrationThread& registration, ThreadSettings scheduling)
    : stage_(settings, [&maps = files.maps()](std::uint32_t session) { return read_map(maps, session); }),
      map_(map),
      registration_(registration),
      scans_(ipc::topics::kRegisteredScan),
      priors_(ipc::topics::kPrior),
      waiter_({&scans_.raw()}),
      worker_(std::move(scheduling), waiter_, [this] { loop(); }) {
  stage_.begin_at(files.start(), files.stays());
}

void PlaceThread::loop() noexcept {
  drain_until_stopped(waiter_, worker_.heartbeat(), [this] { drain(); });
}

void PlaceThread::drain() noexcept {
  while (const auto scan = scans_.take()) {
    // The prior of the scan's end, not the newest: this thread may be late by seconds.
    while (stage_.prior_ns() < scan->pose.stamp_ns) {
      const auto prior = priors_.take();
      if (!prior) break;
      stage_.add_prior(*prior);
    }
    try {
      follow(stage_.add_scan(*scan), scan->pose);
    } catch (const std::exception& error) {
      spdlog::error("the search of the place ends: {}", error.what());
      registration_.give_up_place();
    }
    status_.put(stage_.status());
  }
}

void PlaceThread::follow(const PlaceOrder& order, const PoseEstimate& pose) {
  if (order.give_up) registration_.give_up_place();
  if (order.T_map_odom) {
    const PlaceHint hint = order.hint_at(pose);
    looked_before_ = map_.looked();
    map_.look_at({hint.p_map_m.x(), hint.p_map_m.y(), hint.z_m});
    found_ = order;
  } else if (found_ && stage_.status().state != PlaceState::kTold) {
    found_.reset();
  } else if (found_ && map_.looked() != looked_before_) {
    registration_.offer_place(found_->hint_at(pose));
    found_.reset();
  }
}

}  // namespace isobar
