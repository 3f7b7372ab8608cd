// SPDX-License-Identifier: BSD-3-Clause
#include "drivers/velodyne/decoder.hpp"

#include <cstdio>

namespace isobar::velodyne {

Decoder::Decoder(const ModelTraits& traits, const LidarLimits& limits) : traits_(traits), returns_(traits) {
  returns_.set_limits(limits);
}

DecodeStatus Decoder::read(std::span<const std::uint8_t> payload, PacketColumns& packet) {
  DataPacket data;
  const DecodeStatus status = read_packet(payload, data);
  if (status == DecodeStatus::kNoPoints) read_position(payload);
  if (status != DecodeStatus::kOk) return status;
  if (!is_of_model(data)) return DecodeStatus::kWrongModel;
  packet.device_ns = static_cast<std::int64_t>(data.timestamp_us) * 1'000 % kClockPeriodNs;
  packet.duration_ns = traits_.packet_duration_ns(data.dual);
  packet.column_ns = traits_.firing_offset_ns(0, kChannels - 1, false);
  packet.identity = std::uint64_t{data.timestamp_us} << 32U | data.azimuth[0];
  packet.count = kBlocks;
  for (std::size_t block = 0; block < kBlocks; ++block) {
    packet.turn[block] = data.azimuth[block];
    packet.offset_ns[block] = traits_.firing_offset_ns(static_cast<int>(block), 0, data.dual);
  }
  return DecodeStatus::kOk;
}

bool Decoder::is_data(std::span<const std::uint8_t> payload) const {
  DataPacket data;
  if (read_packet(payload, data) != DecodeStatus::kOk) return false;
  if (data.product_id == static_cast<std::uint8_t>(traits_.model)) return true;
  return data.product_id == static_cast<std::uint8_t>(Model::kHdl32e) && traits_.model == Model::kVlp16 &&
         evidence_.has_sixteen_lasers();
}

std::uint32_t Decoder::decode(std::span<const std::uint8_t> payload, const PacketColumns& packet, int first,
                              int end, std::int64_t since_start_ns, ScanPoint* out) const {
  DataPacket data;
  data.bytes = payload.data();
  data.dual = payload[kReturnModeOffset] == static_cast<std::uint8_t>(ReturnMode::kDual);
  for (std::size_t block = 0; block < kBlocks; ++block) data.azimuth[block] = packet.turn[block];
  return returns_.decode(data, packet, first, end, since_start_ns, out);
}

/// The product id decides, except between VLP-16 and HDL-32E: ModelEvidence.
bool Decoder::is_of_model(const DataPacket& packet) {
  const bool says_model = packet.product_id == static_cast<std::uint8_t>(traits_.model);
  if (packet.product_id == static_cast<std::uint8_t>(Model::kHdl32e)) {
    evidence_.add(packet);
    const bool sixteen = evidence_.has_sixteen_lasers();
    if (says_model ? !sixteen : sixteen && traits_.model == Model::kVlp16) return true;
    fires_otherwise_ = says_model;
  } else if (says_model) {
    return true;
  }
  wrong_product_id_ = packet.product_id;
  return false;
}

/// Byte 202 of a position packet: state of the pulse per second (63-9243, 9.3.4 "Position packet").
void Decoder::read_position(std::span<const std::uint8_t> payload) {
  constexpr std::size_t kPpsOffset = 202;
  constexpr std::array<LidarSync, 4> kStates{LidarSync::kFree, LidarSync::kLocking, LidarSync::kLocked,
                                             LidarSync::kFault};
  const std::uint8_t state = payload[kPpsOffset];
  sync_ = state < kStates.size() ? kStates[state] : LidarSync::kUnknown;
}

std::string Decoder::mismatch() const {
  const std::string name(traits_.name);
  if (fires_otherwise_) {
    return "packets say " + name +
           " in their product id, but fire as a VLP-16: lidar.model = \"VLP-16\" would fit";
  }
  std::array<char, 96> text{};
  const auto seen = product_name(wrong_product_id_);
  std::snprintf(text.data(), text.size(), "packets of %.*s (product id 0x%02X), but %s is configured",
                static_cast<int>(seen.size()), seen.data(), static_cast<unsigned>(wrong_product_id_),
                name.c_str());
  return text.data();
}

}  // namespace isobar::velodyne
