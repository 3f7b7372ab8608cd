// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include "drivers/hesai/packet_format.hpp"
#include "drivers/lidar/angle_table.hpp"
#include "drivers/lidar/lidar_decoder.hpp"
#include "drivers/lidar/turn_directions.hpp"

namespace isobar::hesai {

/// LidarDecoder of the Hesai XT family. Points are in the maker's frame: azimuth 0 is the y axis, x to the
/// right. All lasers of a firing have the azimuth of their block, as in the maker's own evaluation. A block is a
/// column; in dual return two blocks hold the same firing.
class Decoder final : public LidarDecoder {
 public:
  /// @param angles of this sensor (read_angle_file); empty: the nominal ones
  explicit Decoder(const ModelTraits& traits, const LidarLimits& limits = {}, const AngleTable& angles = {});

  DecodeStatus read(std::span<const std::uint8_t> payload, PacketColumns& packet) override;
  [[nodiscard]] bool is_data(std::span<const std::uint8_t> payload) const override;
  std::uint32_t decode(std::span<const std::uint8_t> payload, const PacketColumns& packet, int first, int end,
                       std::int64_t since_start_ns, ScanPoint* out) const override;
  void set_limits(const LidarLimits& limits) override;

  [[nodiscard]] std::string_view model() const override { return traits_.name; }
  [[nodiscard]] std::uint32_t points_per_column() const override {
    return static_cast<std::uint32_t>(traits_.lasers);
  }
  [[nodiscard]] std::size_t longest_packet() const override {
    return traits_.packet_bytes() + kSequenceBytes;
  }
  [[nodiscard]] std::string mismatch() const override { return mismatch_; }

 private:
  struct Beam {
    float cos_elevation;
    float sin_elevation;
    float cos_ahead;  // of the azimuth ahead of the block's
    float sin_ahead;
    std::uint32_t ahead;     // the same [0.01 deg], 0 … kFullTurn - 1
    std::int64_t firing_ns;  // after the block's first laser
    std::uint8_t ring;
  };

  [[nodiscard]] DecodeStatus check(std::span<const std::uint8_t> payload) const;
  [[nodiscard]] std::uint32_t decode_block(const std::uint8_t* block, const std::uint8_t* other_return,
                                           std::int64_t since_start_ns, ScanPoint* out) const;

  const ModelTraits& traits_;
  std::vector<Beam> beams_;
  const std::vector<TurnDirection>& directions_;
  CountLimits limits_;
  LidarLimits limits_m_;
  double unit_m_ = 0.004;
  std::string mismatch_;
};

}  // namespace isobar::hesai
