// SPDX-License-Identifier: BSD-3-Clause
// Replaces pcl_peers.cpp in builds without PCL.
#include "tests/benchmark/driver/peer.hpp"

namespace isobar::bench {

std::vector<std::unique_ptr<Peer>> make_peers(const PeerSettings& /*settings*/) { return {}; }

std::string peers_refusal() { return "built without PCL (tools/install benchmark)"; }

}  // namespace isobar::bench
