// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <string>
#include <vector>

#include "drivers/lidar/angle_table.hpp"
#include "drivers/lidar/lidar_decoder.hpp"
#include "drivers/lidar/turn_directions.hpp"
#include "drivers/robosense/packet_format.hpp"

namespace isobar::robosense {

/// LidarDecoder of RoboSense's mechanical lidars. The angles of a sensor are its own: they come with its device
/// information (DIFOP) about once a second; until then, and without, the nominal ones hold. read() takes both kinds
/// of packets. x is at azimuth 0. A block is a column: two firings of 16 lasers, or in dual return one firing
/// twice.
class Decoder final : public LidarDecoder {
 public:
  /// @param angles of this sensor (read_angle_file), which then replace those of the DIFOP; empty: none
  explicit Decoder(const ModelTraits& traits, const LidarLimits& limits = {}, const AngleTable& angles = {});

  DecodeStatus read(std::span<const std::uint8_t> payload, PacketColumns& packet) override;
  [[nodiscard]] bool is_data(std::span<const std::uint8_t> payload) const override;
  std::uint32_t decode(std::span<const std::uint8_t> payload, const PacketColumns& packet, int first, int end,
                       std::int64_t since_start_ns, ScanPoint* out) const override;
  void set_limits(const LidarLimits& limits) override;

  [[nodiscard]] std::string_view model() const override { return traits_.name; }
  [[nodiscard]] std::uint32_t points_per_column() const override { return kChannels; }
  [[nodiscard]] std::size_t longest_packet() const override { return kPacketBytes; }
  [[nodiscard]] std::string mismatch() const override { return mismatch_; }
  /// Pace of the packets against the return mode of the device information.
  [[nodiscard]] const char* contradiction() const override;
  [[nodiscard]] LidarSync sync() const override { return sync_; }
  /// Whether the sensor's own angles are known.
  [[nodiscard]] bool has_own_angles() const { return has_own_angles_; }

 private:
  struct Beam {
    float cos_elevation = 1.0F;
    float sin_elevation = 0.0F;
    std::uint32_t ahead = 0;  // azimuth ahead of the head's, 0 … kFullTurn - 1
    std::uint8_t ring = 0;
  };
  struct Block {
    const std::uint8_t* channels;
    std::uint32_t azimuth;
    std::uint32_t step;  // rotation until the next block [0.01 deg]
    std::int64_t since_start_ns;
  };

  [[nodiscard]] DecodeStatus check(std::span<const std::uint8_t> payload) const;
  void use(const AngleTable& angles);
  void read_device_information(std::span<const std::uint8_t> payload);
  [[nodiscard]] std::int64_t time_ns(const std::uint8_t* header) const;
  void follow_pace(std::int64_t device_ns);
  std::uint32_t decode_block(const Block& block, ScanPoint* out) const;

  const ModelTraits& traits_;
  std::array<Beam, kChannels> beams_;
  const std::vector<TurnDirection>& directions_;
  CountLimits limits_;
  bool keeps_angles_ = false;  // those of a file
  bool has_own_angles_ = false;
  bool dual_ = false;
  bool knows_mode_ = false;
  int packets_against_mode_ = 0;  // in a row
  std::int64_t block_ns_;         // from block to block
  std::int64_t last_ns_ = 0;
  std::string mismatch_;
  LidarSync sync_ = LidarSync::kUnknown;
};

}  // namespace isobar::robosense
