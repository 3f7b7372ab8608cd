// SPDX-License-Identifier: BSD-3-Clause
// Pass with the peers: our registration and the peers process each scan in turn, on one thread.
#pragma once

#include <string>
#include <vector>

#include "run/evaluation/trajectory.hpp"
#include "tests/benchmark/driver/data_set.hpp"
#include "tests/benchmark/driver/peer.hpp"

namespace isobar::bench {

/// Results of one system in the pass.
struct SystemRun {
  std::string name;
  std::vector<double> registration_ms;  ///< per scan
  std::vector<double> map_ms;           ///< per scan; 0 without a map update
  std::vector<evaluation::StampedPose> poses;
  std::size_t failures = 0;  ///< scans without convergence
};

struct PeerPass {
  SystemRun ours;
  std::vector<SystemRun> peers;  ///< series as long as ours
};

/// Processes the first `max_scans` scans after the start. Our time includes deskewing; the peers get the
/// deskewed cloud, and their time includes thinning. All start from the same priors through their own motion
/// model: roll and pitch from gravity, height from pressure, translation from dead reckoning. All update
/// their map under the same conditions (MapConfig::update_…).
PeerPass measure_peers(DataSet& data, std::vector<std::unique_ptr<Peer>> peers, std::size_t max_scans);

}  // namespace isobar::bench
