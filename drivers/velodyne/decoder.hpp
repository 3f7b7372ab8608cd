// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <memory>

#include "drivers/lidar/lidar_decoder.hpp"
#include "drivers/velodyne/data_packet.hpp"
#include "drivers/velodyne/model_evidence.hpp"
#include "drivers/velodyne/return_decoder.hpp"

namespace isobar::velodyne {

/// LidarDecoder of the Velodyne models with packets of 12 blocks and 32 channels. The sensor's time is the
/// time past the hour.
class Decoder final : public LidarDecoder {
 public:
  explicit Decoder(const ModelTraits& traits, const LidarLimits& limits = {});

  DecodeStatus read(std::span<const std::uint8_t> payload, PacketColumns& packet) override;
  [[nodiscard]] bool is_data(std::span<const std::uint8_t> payload) const override;
  std::uint32_t decode(std::span<const std::uint8_t> payload, const PacketColumns& packet, int first, int end,
                       std::int64_t since_start_ns, ScanPoint* out) const override;
  void set_limits(const LidarLimits& limits) override { returns_.set_limits(limits); }

  [[nodiscard]] std::string_view model() const override { return traits_.name; }
  [[nodiscard]] std::uint32_t points_per_column() const override { return kChannels; }
  [[nodiscard]] std::size_t longest_packet() const override { return kDataPacketBytes; }
  [[nodiscard]] std::int64_t period_ns() const override { return kClockPeriodNs; }
  [[nodiscard]] std::string mismatch() const override;
  [[nodiscard]] LidarSync sync() const override { return sync_; }

 private:
  [[nodiscard]] bool is_of_model(const DataPacket& packet);
  void read_position(std::span<const std::uint8_t> payload);

  const ModelTraits& traits_;
  ReturnDecoder returns_;
  ModelEvidence evidence_;
  std::uint8_t wrong_product_id_ = 0;
  bool fires_otherwise_ =
      false;  // the refused packets say the model that is configured, but fire as a VLP-16
  LidarSync sync_ = LidarSync::kUnknown;
};

}  // namespace isobar::velodyne
