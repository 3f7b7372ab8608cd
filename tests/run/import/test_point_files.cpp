// SPDX-License-Identifier: BSD-3-Clause
#include <doctest/doctest.h>

#include <cstring>
#include <fstream>

#include "core/errors.hpp"
#include "run/import/point_files.hpp"
#include "tests/support/message_of.hpp"
#include "tests/support/temporary_folder.hpp"

namespace isobar::test::test_point_files {
namespace {

template <typename Value>
Value field_of(const recording::CloudRecord& cloud, const std::string& name, std::size_t point) {
  for (const auto& field : cloud.fields) {
    if (field.name != name) continue;
    Value value{};
    std::memcpy(&value, &cloud.data.at(point * cloud.point_step + field.offset), sizeof(value));
    return value;
  }
  FAIL("no field " << name);
  return {};
}

struct Folder : TemporaryFolder {
  std::filesystem::path write(const std::string& name, const std::string& bytes) const {
    std::ofstream(path() / name, std::ios::binary) << bytes;
    return path() / name;
  }
};

std::string bytes_of_floats(std::initializer_list<float> values) {
  std::string bytes;
  for (const float value : values) bytes.append(reinterpret_cast<const char*>(&value), sizeof(value));
  return bytes;
}

const char* const kPcdHead =
    "# .PCD v0.7\nVERSION 0.7\nFIELDS x y z _ ring\nSIZE 4 4 4 1 2\nTYPE F F F U U\nCOUNT 1 1 1 2 1\nWIDTH "
    "2\nHEIGHT 1\n"
    "VIEWPOINT 0 0 0 1 0 0 0\nPOINTS 2\nDATA ";

}  // namespace

TEST_CASE("a PCD gives its points as text and binary, past its padding") {
  const Folder folder;
  const auto text = folder.write("t.pcd", std::string(kPcdHead) + "ascii\n1 2 3 0 0 7\n4 nan 6 0 0 9\n");
  const std::string padding("..\x07\x00", 4);
  const auto binary =
      folder.write("b.pcd", std::string(kPcdHead) + "binary\n" + bytes_of_floats({1, 2, 3}) + padding +
                                bytes_of_floats({4, 5, 6}) + std::string("..\x09\x00", 4));
  for (const auto& file : {text, binary}) {
    const recording::CloudRecord cloud = imports::read_point_file(file);
    REQUIRE(cloud.width == 2);
    CHECK(field_of<float>(cloud, "z", 0) == 3.0F);
    CHECK(field_of<float>(cloud, "x", 1) == 4.0F);
    CHECK(field_of<std::uint16_t>(cloud, "ring", 1) == 9);
  }
}

TEST_CASE("a compressed PCD is put together from its columns") {
  const Folder folder;
  // Columns x, y, z, padding, ring of two points: 32 bytes, as LZF literals of at most 32 bytes.
  const std::string columns =
      bytes_of_floats({1, 4, 2, 5, 3, 6}) + "...." + std::string("\x07\x00\x09\x00", 4);
  REQUIRE(columns.size() == 32);
  const std::string packed = std::string(1, '\x1f') + columns;
  const std::uint32_t sizes[2] = {static_cast<std::uint32_t>(packed.size()), 32};  // NOLINT
  const auto file = folder.write("c.pcd", std::string(kPcdHead) + "binary_compressed\n" +
                                              std::string(reinterpret_cast<const char*>(sizes), 8) + packed);
  const recording::CloudRecord cloud = imports::read_point_file(file);
  CHECK(field_of<float>(cloud, "y", 1) == 5.0F);
  CHECK(field_of<std::uint16_t>(cloud, "ring", 0) == 7);
}

TEST_CASE("a PLY gives its points as text and in both byte orders") {
  const Folder folder;
  const std::string head =
      "element vertex 2\nproperty float x\nproperty float y\nproperty float z\nproperty uchar ring\n"
      "element face 0\nproperty list uchar int vertex_indices\nend_header\n";
  const auto text = folder.write("t.ply", "ply\nformat ascii 1.0\n" + head + "1 2 3 7\n4 5 6 9\n");
  const auto little =
      folder.write("l.ply", "ply\nformat binary_little_endian 1.0\n" + head + bytes_of_floats({1, 2, 3}) +
                                "\x07" + bytes_of_floats({4, 5, 6}) + "\x09");
  for (const auto& file : {text, little}) {
    const recording::CloudRecord cloud = imports::read_point_file(file);
    REQUIRE(cloud.width == 2);
    CHECK(field_of<float>(cloud, "y", 1) == 5.0F);
    CHECK(field_of<std::uint8_t>(cloud, "ring", 1) == 9);
    CHECK_FALSE(cloud.is_bigendian);
  }
  const auto big =
      folder.write("b.ply", "ply\nformat binary_big_endian 1.0\n" + head + std::string(26, '\0'));
  CHECK(imports::read_point_file(big).is_bigendian);
}

TEST_CASE("a KITTI scan gives four floats a point, with reflectance up to 255") {
  const Folder folder;
  const auto file = folder.write("0.bin", bytes_of_floats({1, 2, 3, 0.5F, 4, 5, 6, 1.0F}));
  const recording::CloudRecord cloud = imports::read_point_file(file);
  REQUIRE(cloud.width == 2);
  CHECK(field_of<float>(cloud, "x", 1) == 4.0F);
  CHECK(field_of<float>(cloud, "intensity", 0) == 127.5F);
}

TEST_CASE("a nuScenes scan gives five floats a point, and bytes of another layout are no scan") {
  const Folder folder;
  const auto scan = folder.write("a.pcd.bin", bytes_of_floats({1, 2, 3, 40, 7, 4, 5, 6, 80, 8}));
  const recording::CloudRecord cloud = imports::read_point_file(scan);
  CHECK(cloud.width == 2);
  CHECK(field_of<float>(cloud, "intensity", 1) == 80.0F);
  CHECK(field_of<float>(cloud, "ring", 1) == 8.0F);
  // NCLT: 16-bit coordinates.
  std::string packed;
  for (int i = 0; i < 400; ++i) packed += static_cast<char>(i * 37);
  const auto other = folder.write("b.bin", packed);
  CHECK(message_of([&] { (void)imports::read_point_file(other); }).find("is no scan of KITTI's form") !=
        std::string::npos);
}

TEST_CASE("a file of points that is cut gives the whole ones, and a wrong one names its rule") {
  const Folder folder;
  const auto cut = folder.write("cut.pcd", std::string(kPcdHead) + "binary\n" + bytes_of_floats({1, 2, 3}) +
                                               "..\x07\x01"
                                               "zz");
  std::string damage;
  CHECK(imports::read_point_file(cut, &damage).width == 1);
  CHECK(damage.find(": ends after point 1 of ") != std::string::npos);
  const auto refusal = [&](const std::string& name, const std::string& bytes) {
    const auto file = folder.write(name, bytes);
    return message_of([&] { (void)imports::read_point_file(file); });
  };
  CHECK(refusal("a.pcd", "anything\n").find("has no line DATA") != std::string::npos);
  CHECK(refusal("b.pcd", "FIELDS x\nSIZE 4 4\nDATA ascii\n").find("SIZE has another number") !=
        std::string::npos);
  CHECK(refusal("c.pcd", "FIELDS x\nSIZE 4\nTYPE F\nCOUNT 1\nPOINTS 999999999999\nDATA binary\n")
            .find("million") != std::string::npos);
  CHECK(refusal("d.ply", "ply\nelement vertex 1\nproperty strange x\n").find("type that is not read") !=
        std::string::npos);
  CHECK(refusal("e.bin", "short").find("holds no points") != std::string::npos);
  CHECK(refusal("f.pcd", std::string(kPcdHead) + "binary_compressed\n" +
                             std::string("\x02\0\0\0\x20\0\0\0\xff\xff", 10))
            .find("damaged") != std::string::npos);
}

}  // namespace isobar::test::test_point_files
