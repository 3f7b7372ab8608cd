// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "drivers/lidar_models/lidar_models.hpp"

namespace isobar::tools {

/// Tells the model of a lidar by its packets: those that each driver accepts are counted.
class ModelVotes {
 public:
  /// Packets that are judged; later ones say nothing new.
  static constexpr std::size_t kMostPackets = 400;

  ModelVotes();
  void add(std::span<const std::uint8_t> payload);

  /// The model whose driver takes most packets, most of all that are of a data packet's size; empty: none.
  [[nodiscard]] std::string model() const;
  /// What a driver says about packets that look like its own and are not; empty: nothing.
  [[nodiscard]] const std::string& mismatch() const { return mismatch_; }
  [[nodiscard]] std::size_t packets() const { return packets_; }

 private:
  std::vector<std::unique_ptr<LidarDecoder>> decoders_;  // of the models that need no calibration
  std::map<std::string, std::size_t> accepted_;
  std::size_t packets_ = 0;
  std::string mismatch_;
};

}  // namespace isobar::tools
