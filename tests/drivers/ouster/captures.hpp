// SPDX-License-Identifier: BSD-3-Clause
// Independent reading of Ouster's captures: payloads by fixed offsets, fields by the table of Ouster's sensor
// documentation. The data are not part of this project.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

namespace isobar::test {

struct CapturedPacket {
  std::int64_t stamp_ns = 0;
  std::uint16_t port = 0;
  std::vector<std::uint8_t> bytes;
};

/// UDP payloads of a little-endian Ethernet pcap without IP options. Fragments are joined where they follow each
/// other; a first fragment drops an unfinished datagram.
std::vector<CapturedPacket> read_capture(const std::filesystem::path& file);

/// Layout of a packet by literal offsets.
struct FieldPlan {
  int packet_header, column_header, pixel, column_footer, rows;
};
/// A field of the pixels.
struct PixelField {
  const char* name;
  int offset, bytes;
  std::uint32_t mask;
  int up, down;    // shifts
  int hash_bytes;  // width in the digest
};

std::uint64_t bytes_at(const std::vector<std::uint8_t>& packet, int at, int count);
std::uint32_t pixel_value(const FieldPlan& plan, const PixelField& field,
                          const std::vector<std::uint8_t>& packet, int column, int row);
int column_at(const FieldPlan& plan, int column);
bool is_valid_column(const FieldPlan& plan, const std::vector<std::uint8_t>& packet, int column);

std::string md5(const std::string& bytes);

}  // namespace isobar::test
