// SPDX-License-Identifier: BSD-3-Clause
#include "tools/import/model_votes.hpp"

namespace isobar::tools {

ModelVotes::ModelVotes() {
  for (const LidarModel& model : lidar_models()) {
    if (model.needs_calibration) continue;
    LidarConfig config;
    config.model = model.name;
    decoders_.push_back(make_lidar_decoder(config));
  }
}

void ModelVotes::add(std::span<const std::uint8_t> payload) {
  if (packets_ >= kMostPackets) return;
  ++packets_;
  for (const auto& decoder : decoders_) {
    // Before read(), which learns from a packet what the next ones are.
    const bool is_its = decoder->is_data(payload);
    PacketColumns columns;
    const DecodeStatus status = decoder->read(payload, columns);
    if (status == DecodeStatus::kOk) ++accepted_[std::string(decoder->model())];
    if (status == DecodeStatus::kWrongModel && is_its && mismatch_.empty()) mismatch_ = decoder->mismatch();
  }
}

std::string ModelVotes::model() const {
  std::string best;
  std::size_t most = 0;
  // In the order of the list: of two drivers that take the same packets the first, as the list is of the usual ones first.
  for (const auto& decoder : decoders_) {
    const auto accepted = accepted_.find(std::string(decoder->model()));
    if (accepted == accepted_.end() || accepted->second <= most) continue;
    best = accepted->first;
    most = accepted->second;
  }
  // Stray packets of the right form are no lidar: a fifth of all, information packets included.
  constexpr std::size_t kLeastShare = 5;
  return most * kLeastShare >= packets_ ? best : std::string();
}

}  // namespace isobar::tools
