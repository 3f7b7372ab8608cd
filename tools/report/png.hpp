// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

namespace isobar::report {

/// An image of palette indices, row-major from the top left.
struct IndexedImage {
  std::size_t width = 0;
  std::size_t height = 0;
  std::vector<std::uint8_t> pixels;                  ///< width * height
  std::vector<std::array<std::uint8_t, 4>> palette;  ///< red, green, blue, opacity; at most 256 entries
};

/// PNG (ISO/IEC 15948), colour type 3 with transparency.
std::string encode_png(const IndexedImage& image);

/// Base64 (RFC 4648).
std::string base64(const std::string& bytes);

/// "data:image/png;base64,…"
std::string png_data_uri(const IndexedImage& image);

}  // namespace isobar::report
