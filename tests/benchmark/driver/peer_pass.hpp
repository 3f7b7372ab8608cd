// SPDX-License-Identifier: BSD-3-Clause
// Ours and the peers side by side: every scan through all of them, one after the other, on one thread.
#pragma once

#include <string>
#include <vector>

#include "run/evaluation/trajectory.hpp"
#include "tests/benchmark/driver/data_set.hpp"
#include "tests/benchmark/driver/peer.hpp"

namespace isobar::bench {

/// What one system did with the scans of the pass.
struct SystemRun {
  std::string name;
  std::vector<double> registration_ms;  ///< a scan
  std::vector<double> map_ms;           ///< a scan; 0 where the map was not updated
  std::vector<evaluation::StampedPose> poses;
  std::size_t failures = 0;  ///< scans on which it did not converge
};

struct PeerPass {
  SystemRun ours;
  std::vector<SystemRun> peers;  ///< as many entries a series as ours
};

/// Takes the first `max_scans` scans after the start. Ours deskews inside of its time; the peers get the same
/// clouds deskewed, and thin them inside of theirs. All start from the same prior by a motion model of their
/// own: roll and pitch from gravity, height from pressure, the way from dead reckoning. All add a scan to the
/// map under the same conditions (MapConfig::update_…).
PeerPass measure_peers(DataSet& data, std::vector<std::unique_ptr<Peer>> peers, std::size_t max_scans);

}  // namespace isobar::bench
