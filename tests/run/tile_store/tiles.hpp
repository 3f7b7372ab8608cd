// SPDX-License-Identifier: BSD-3-Clause
// Tiles with bytes that are a function of key and version, so that a test can check what it reads.
#pragma once

#include <cstdint>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>
#include <vector>

#include "run/tile_store/file_tile_store.hpp"

namespace isobar::test {

using Bytes = std::vector<std::byte>;

/// `size` bytes that differ from those of any other key, version or size.
inline Bytes tile_bytes(const TileKey& key, std::uint32_t version, std::size_t size) {
  Bytes bytes(size);
  std::uint64_t state = key.hash() ^ (version * 0x9E3779B97F4A7C15ULL) ^ size;
  for (std::size_t i = 0; i < size; i += 8) {
    state = state * 6364136223846793005ULL + 1442695040888963407ULL;
    std::memcpy(bytes.data() + i, &state, std::min<std::size_t>(8, size - i));
  }
  return bytes;
}

inline TileKey key_number(int n) { return {n % 7 - 3, n / 7 - 5, n % 3 - 1}; }

inline std::string content_of(const std::filesystem::path& file) {
  std::ifstream in(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), std::istreambuf_iterator<char>()};
}

inline void write_content(const std::filesystem::path& file, const std::string& content) {
  std::ofstream(file, std::ios::binary | std::ios::trunc) << content;
}

}  // namespace isobar::test
