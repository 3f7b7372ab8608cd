// SPDX-License-Identifier: BSD-3-Clause
// Other registrations that run beside ours on the same clouds.
#pragma once

#include <Eigen/Geometry>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "core/samples.hpp"
#include "tests/benchmark/driver/data_set.hpp"

namespace isobar::bench {

struct PeerResult {
  Eigen::Isometry3d T_map_base = Eigen::Isometry3d::Identity();
  bool converged = false;
};

/// A registration with a local map of its own. One thread.
class Peer {
 public:
  virtual ~Peer() = default;
  [[nodiscard]] virtual std::string name() const = 0;
  /// Registers a deskewed cloud (p_base) to the map, starting at `guess`. With an empty map the guess is the
  /// result.
  virtual PeerResult register_cloud(std::span<const ScanPoint> cloud, const Eigen::Isometry3d& guess) = 0;
  /// Adds the cloud that was registered last to the map, at `T_map_base`.
  virtual void update_map(std::span<const ScanPoint> cloud, const Eigen::Isometry3d& T_map_base) = 0;
};

/// Settings that they share with ours.
struct PeerSettings {
  double first_distance_m = 0.8;  ///< largest between a point and its partner, of our first iteration …
  double last_distance_m = 0.35;  ///< … and of our last: a peer has one, and takes what suits it
  int max_iterations = 12;
  double convergence_m = 0.0008;
  double map_radius_m = 70.0;
};

/// Those that this program was built with.
std::vector<std::unique_ptr<Peer>> make_peers(const PeerSettings& settings);

/// Why make_peers() makes none; empty where it makes some.
std::string peers_refusal();

}  // namespace isobar::bench
