// SPDX-License-Identifier: BSD-3-Clause
// Stands in for pcl_peers.cpp where there is no PCL.
#include "tests/benchmark/driver/peer.hpp"

namespace isobar::bench {

std::vector<std::unique_ptr<Peer>> make_peers(const PeerSettings& /*settings*/) { return {}; }

std::string peers_refusal() { return "built without PCL (tools/install benchmark)"; }

}  // namespace isobar::bench
