// SPDX-License-Identifier: BSD-3-Clause
#include "tools/report/png.hpp"

#include <zlib.h>

#include <algorithm>
#include <stdexcept>
#include <string_view>

namespace isobar::report {

namespace {

void append_u32(std::string& bytes, std::uint32_t value) {
  for (const unsigned shift : {24U, 16U, 8U, 0U}) bytes += static_cast<char>((value >> shift) & 0xFFU);
}

void append_chunk(std::string& bytes, std::string_view type, const std::string& data) {
  append_u32(bytes, static_cast<std::uint32_t>(data.size()));
  const std::string checked = std::string(type) + data;
  bytes += checked;
  const uLong crc =
      crc32(0, reinterpret_cast<const Bytef*>(checked.data()), static_cast<uInt>(checked.size()));
  append_u32(bytes, static_cast<std::uint32_t>(crc));
}

std::string deflated(const std::string& raw) {
  uLongf size = compressBound(static_cast<uLong>(raw.size()));
  std::string packed(size, '\0');
  const int status = compress2(reinterpret_cast<Bytef*>(packed.data()), &size,
                               reinterpret_cast<const Bytef*>(raw.data()), static_cast<uLong>(raw.size()), 9);
  if (status != Z_OK) throw std::runtime_error("zlib could not compress an image");
  packed.resize(size);
  return packed;
}

}  // namespace

std::string encode_png(const IndexedImage& image) {
  std::string header;
  append_u32(header, static_cast<std::uint32_t>(image.width));
  append_u32(header, static_cast<std::uint32_t>(image.height));
  // 8 bits per pixel, palette, deflate, filter method 0, not interlaced.
  header += std::string("\x08\x03\x00\x00\x00", 5);
  std::string colours;
  std::string opacities;
  for (const auto& colour : image.palette) {
    for (std::size_t i = 0; i < 3; ++i) colours += static_cast<char>(colour[i]);
    opacities += static_cast<char>(colour[3]);
  }
  std::string rows;
  rows.reserve((image.width + 1) * image.height);
  for (std::size_t y = 0; y < image.height; ++y) {
    rows += '\0';  // filter "none"
    rows.append(reinterpret_cast<const char*>(image.pixels.data()) + y * image.width, image.width);
  }
  std::string bytes("\x89PNG\r\n\x1a\n", 8);
  append_chunk(bytes, "IHDR", header);
  append_chunk(bytes, "PLTE", colours);
  append_chunk(bytes, "tRNS", opacities);
  append_chunk(bytes, "IDAT", deflated(rows));
  append_chunk(bytes, "IEND", "");
  return bytes;
}

std::string base64(const std::string& bytes) {
  constexpr std::string_view kLetters = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string text;
  text.reserve((bytes.size() + 2) / 3 * 4);
  for (std::size_t i = 0; i < bytes.size(); i += 3) {
    std::uint32_t group = 0;
    for (std::size_t j = 0; j < 3; ++j) {
      group = (group << 8U) | (i + j < bytes.size() ? static_cast<std::uint8_t>(bytes[i + j]) : 0U);
    }
    const std::size_t letters = std::min<std::size_t>(3, bytes.size() - i) + 1;
    for (std::size_t j = 0; j < 4; ++j) text += j < letters ? kLetters[(group >> (18U - 6U * j)) & 63U] : '=';
  }
  return text;
}

std::string png_data_uri(const IndexedImage& image) {
  return "data:image/png;base64," + base64(encode_png(image));
}

}  // namespace isobar::report
