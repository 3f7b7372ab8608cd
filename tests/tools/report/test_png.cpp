// SPDX-License-Identifier: BSD-3-Clause
#include <doctest/doctest.h>
#include <zlib.h>

#include <cmath>
#include <cstdint>
#include <string>
#include <vector>

#include "tools/report/map_view.hpp"
#include "tools/report/png.hpp"

namespace isobar::test::test_png {

using namespace isobar::report;

namespace {

std::uint32_t u32(const std::string& bytes, std::size_t at) {
  std::uint32_t value = 0;
  for (std::size_t i = 0; i < 4; ++i) value = value << 8U | static_cast<std::uint8_t>(bytes[at + i]);
  return value;
}

struct Chunk {
  std::string type;
  std::string data;
};

/// Splits a PNG and checks every chunk's length and checksum.
std::vector<Chunk> chunks_of(const std::string& png) {
  REQUIRE(png.substr(0, 8) == std::string("\x89PNG\r\n\x1a\n", 8));
  std::vector<Chunk> chunks;
  for (std::size_t at = 8; at < png.size();) {
    const std::size_t size = u32(png, at);
    REQUIRE(at + 12 + size <= png.size());
    const std::string checked = png.substr(at + 4, 4 + size);
    const auto crc =
        crc32(0, reinterpret_cast<const Bytef*>(checked.data()), static_cast<uInt>(checked.size()));
    CHECK(crc == u32(png, at + 8 + size));
    chunks.push_back({checked.substr(0, 4), checked.substr(4)});
    at += 12 + size;
  }
  return chunks;
}

}  // namespace

TEST_CASE("pixels, colours and opacities of an image are encoded in its PNG") {
  IndexedImage image{5, 3, {}, {{1, 2, 3, 0}, {250, 128, 7, 255}, {9, 9, 9, 77}}};
  for (std::uint8_t i = 0; i < 15; ++i) image.pixels.push_back(i % 3);
  const std::vector<Chunk> chunks = chunks_of(encode_png(image));
  REQUIRE(chunks.size() == 5);
  CHECK(chunks[0].type == "IHDR");
  CHECK(u32(chunks[0].data, 0) == 5);
  CHECK(u32(chunks[0].data, 4) == 3);
  CHECK(chunks[0].data.substr(8) == std::string("\x08\x03\x00\x00\x00", 5));
  CHECK(chunks[1].data == std::string("\x01\x02\x03\xfa\x80\x07\x09\x09\x09"));
  CHECK(chunks[2].data == std::string("\x00\xff\x4d", 3));
  CHECK(chunks[4].type == "IEND");
  std::string rows(18, '\0');
  uLongf size = rows.size();
  REQUIRE(uncompress(reinterpret_cast<Bytef*>(rows.data()), &size,
                     reinterpret_cast<const Bytef*>(chunks[3].data.data()), chunks[3].data.size()) == Z_OK);
  REQUIRE(size == 18);
  for (std::size_t y = 0; y < 3; ++y) {
    CHECK(rows[6 * y] == 0);
    for (std::size_t x = 0; x < 5; ++x)
      CHECK(static_cast<std::uint8_t>(rows[6 * y + 1 + x]) == image.pixels[5 * y + x]);
  }
}

TEST_CASE("base64 gives the test vectors of RFC 4648, section 10") {
  CHECK(base64("").empty());
  CHECK(base64("f") == "Zg==");
  CHECK(base64("fo") == "Zm8=");
  CHECK(base64("foo") == "Zm9v");
  CHECK(base64("foobar") == "Zm9vYmFy");
  CHECK(base64("\xff\xfe\xfd") == "//79");
}

TEST_CASE(
    "a map point darkens its pixel, more points darken it more; points outside or not finite are ignored") {
  const Range u{0.0, 10.0};
  const Range v{-2.0, 2.0};
  std::vector<MapPoint> points{{0.5F, 1.5F}};
  for (int i = 0; i < 30; ++i) points.push_back({9.5F, -1.5F});
  points.push_back({11.0F, 0.0F});
  points.push_back({-1e30F, NAN});
  const IndexedImage image = density_image(points, u, v, 10, 4);
  std::size_t dark = 0;
  for (const std::uint8_t pixel : image.pixels) dark += pixel > 0 ? 1 : 0;
  CHECK(dark == 2);
  CHECK(image.pixels[0] > 0);                 // top left: v points up
  CHECK(image.pixels[39] > image.pixels[0]);  // bottom right
  CHECK(image.pixels[39] < image.palette.size());
  CHECK(image.palette[0][3] == 0);  // an empty pixel is transparent
}

}  // namespace isobar::test::test_png
