// SPDX-License-Identifier: BSD-3-Clause
// Two buildings under one numbering, as if the robot of the first had gone on in the second.
#pragma once

#include <Eigen/Geometry>
#include <cstddef>
#include <cstdint>

#include "core/loops/building.hpp"
#include "core/loops/building_storage.hpp"

namespace isobar {

/// Storage of a joined building: reads the scans of both. What is added goes nowhere.
class JoinedScans final : public BuildingStorage {
 public:
  /// Both outlive this.
  JoinedScans(BuildingStorage& a, BuildingStorage& b) : a_(a), b_(b) {}

  /// Handle of a scan of B.
  [[nodiscard]] static ScanHandle of_b(ScanHandle handle) {
    return handle == kNoScanHandle ? handle : handle | kOfB;
  }
  void add_submap(const Submap& /*submap*/) override {}
  void add_key(std::size_t /*submap*/, KeyScan& /*key*/, const RegisteredScan& /*scan*/) override {}
  void add_loop(const Loop& /*loop*/) override {}
  void add_move(std::int64_t /*stamp_ns*/) override {}
  bool read_scan(ScanHandle handle, RegisteredScan& out) override {
    const bool of_b = (handle & kOfB) != 0;
    return of_b ? b_.read_scan(handle & ~kOfB, out) : a_.read_scan(handle, out);
  }

 private:
  static constexpr ScanHandle kOfB = ScanHandle{1} << 63U;  // beyond any part of a store

  BuildingStorage& a_;
  BuildingStorage& b_;
};

/// Two buildings as one.
struct JoinedBuildings {
  StoredBuilding building;
  std::size_t submaps_of_a = 0;   ///< the first ones
  std::size_t loops_of_each = 0;  ///< the first ones: of A, then of B
  /// Added to the stamps of B, so that they follow those of A: they order the biases of the altimeter, and a bias of another
  /// run, or of another robot at the same time, is another one.
  std::int64_t b_later_ns = 0;
};

/// Where B lies in A.
struct JoiningPlace {
  Eigen::Isometry3d T_a_b = Eigen::Isometry3d::Identity();
  double air_z_a_b_m = 0.0;  ///< added to B's heights by air pressure
};

/// Joins two buildings, each with a submap at least. The first submap of B is tied to the last one of A by a link that says
/// nothing but roughly where it is: loops tie them. The handles of B become JoinedScans::of_b().
[[nodiscard]] JoinedBuildings join(const StoredBuilding& a, const Building& a_posed, const StoredBuilding& b,
                                   const Building& b_posed, const JoiningPlace& place);

}  // namespace isobar
