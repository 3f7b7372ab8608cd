// SPDX-License-Identifier: BSD-3-Clause
// Peers: other registrations that run on the same clouds.
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

/// A registration with its own local map. Single thread.
class Peer {
 public:
  virtual ~Peer() = default;
  [[nodiscard]] virtual std::string name() const = 0;
  /// Registers a deskewed cloud (p_base) to the map, starting at `guess`; returns `guess` if the map is
  /// empty.
  virtual PeerResult register_cloud(std::span<const ScanPoint> cloud, const Eigen::Isometry3d& guess) = 0;
  /// Adds the last registered cloud to the map, at `T_map_base`.
  virtual void update_map(std::span<const ScanPoint> cloud, const Eigen::Isometry3d& T_map_base) = 0;
};

/// Settings shared with our registration.
struct PeerSettings {
  double first_distance_m = 0.8;  ///< largest distance of a pair in our first iteration
  double last_distance_m = 0.35;  ///< and in our last; a peer has one distance and uses the better
  int max_iterations = 12;
  double convergence_m = 0.0008;
  double map_radius_m = 70.0;
};

/// Peers that this program was built with.
std::vector<std::unique_ptr<Peer>> make_peers(const PeerSettings& settings);

/// Reason why make_peers() is empty; empty text if it is not.
std::string peers_refusal();

}  // namespace isobar::bench
