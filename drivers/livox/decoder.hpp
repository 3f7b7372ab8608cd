// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>

#include "drivers/lidar/lidar_decoder.hpp"
#include "drivers/livox/packet_format.hpp"

namespace isobar::livox {

/// LidarDecoder of the Livox Mid-360, point types 1 and 2. Its scan never repeats and has no turn: a scan is a slice
/// of kSliceNs of the sensor's time, the position in the turn is the phase in the slice, and a packet is one
/// column. It has no rings: all points have ring 0.
///
/// Points without a return (0, 0, 0), and those that the sensor's tag calls of low confidence (rain, dust, between
/// two objects), are dropped.
///
/// Packets with a wrong checksum are garbage, unless the checksums of the first kUnprovenPackets are all wrong: then
/// the firmware does not compute them as documented, and they are not looked at. 0 is "not computed".
class Decoder final : public LidarDecoder {
 public:
  static constexpr std::int64_t kSliceNs = 100'000'000;
  static constexpr int kUnprovenPackets = 64;

  explicit Decoder(const LidarLimits& limits = {}) { set_limits(limits); }

  DecodeStatus read(std::span<const std::uint8_t> payload, PacketColumns& packet) override;
  [[nodiscard]] bool is_data(std::span<const std::uint8_t> payload) const override;
  std::uint32_t decode(std::span<const std::uint8_t> payload, const PacketColumns& packet, int first, int end,
                       std::int64_t since_start_ns, ScanPoint* out) const override;
  void set_limits(const LidarLimits& limits) override;

  [[nodiscard]] std::string_view model() const override { return "Mid-360"; }
  [[nodiscard]] std::uint32_t points_per_column() const override { return kMostPoints; }
  [[nodiscard]] std::size_t longest_packet() const override {
    return kHeaderBytes + std::size_t{kMostPoints} * 14;
  }
  [[nodiscard]] std::string mismatch() const override;
  [[nodiscard]] LidarSync sync() const override { return sync_; }
  bool take_imu(ImuSample& sample) override;

 private:
  enum class Checksums : std::uint8_t { kUnproven, kUsed, kUnused };

  bool has_right_checksum(std::span<const std::uint8_t> payload);
  void read_imu(const std::uint8_t* bytes, std::uint64_t stamp_ns);
  [[nodiscard]] bool keeps(const ScanPoint& point) const;

  double min_range_m_ = 0.0;
  double max_range_m_ = 0.0;
  double mask_start_deg_ = 0.0;
  double mask_width_deg_ = 0.0;
  Checksums checksums_ = Checksums::kUnproven;
  int wrong_checksums_ = 0;
  LidarSync sync_ = LidarSync::kUnknown;
  std::uint8_t other_type_ = 0;
  ImuSample imu_{};
  bool has_imu_ = false;
};

}  // namespace isobar::livox
