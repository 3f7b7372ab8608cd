// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <string>

#include "drivers/lidar/lidar_decoder.hpp"
#include "drivers/lidar/turn_directions.hpp"
#include "drivers/ouster/beam_geometry.hpp"
#include "drivers/ouster/imu_packet.hpp"
#include "drivers/ouster/metadata.hpp"
#include "drivers/ouster/turn_evidence.hpp"

namespace isobar::ouster {

/// LidarDecoder of the Ouster OS0, OS1 and OS2. What a packet does not tell comes from the sensor's metadata.
///
/// A sensor is known by its serial number, which packets and metadata hold. Where the metadata has none the
/// initialisation id must be the same; it changes from start to start of the sensor, so it says nothing when the
/// serial number fits.
class Decoder final : public LidarDecoder {
 public:
  /// @param model "OS0", "OS1" or "OS2"; static storage
  Decoder(std::string_view model, Metadata metadata, const LidarLimits& limits = {});

  DecodeStatus read(std::span<const std::uint8_t> payload, PacketColumns& packet) override;
  [[nodiscard]] bool is_data(std::span<const std::uint8_t> payload) const override;
  std::uint32_t decode(std::span<const std::uint8_t> payload, const PacketColumns& packet, int first, int end,
                       std::int64_t since_start_ns, ScanPoint* out) const override;
  void set_limits(const LidarLimits& limits) override;

  [[nodiscard]] std::string_view model() const override { return model_; }
  [[nodiscard]] std::uint32_t points_per_column() const override;
  [[nodiscard]] std::size_t longest_packet() const override { return layout_.packet_bytes(); }
  [[nodiscard]] std::string mismatch() const override;
  [[nodiscard]] LidarSync sync() const override { return sync_; }
  bool take_imu(ImuSample& sample) override { return imu_.take(sample); }

 private:
  enum class Fault : std::uint8_t { kNone, kSize, kHeader, kSerial, kStart, kColumns };

  [[nodiscard]] DecodeStatus check_size(std::size_t bytes) const;
  [[nodiscard]] Fault check_header(const PacketHeader& header) const;
  DecodeStatus read_columns(const std::uint8_t* bytes, PacketColumns& packet);
  [[nodiscard]] LidarSync sync_at(std::uint64_t timestamp_ns) const;
  std::uint32_t decode_column(const std::uint8_t* column, std::uint16_t time_4us, ScanPoint* out) const;

  std::string_view model_;
  Metadata metadata_;
  PacketLayout layout_;
  BeamGeometry geometry_;
  ImuReader imu_;
  TurnEvidence evidence_;
  CountLimits limits_;
  LidarSync sync_ = LidarSync::kUnknown;

  Fault fault_ = Fault::kNone;  // of the last packet of another model
  std::size_t other_bytes_ = 0;
  PacketHeader other_header_;
};

}  // namespace isobar::ouster
