// SPDX-License-Identifier: BSD-3-Clause
#include <doctest/doctest.h>

#include <cstring>
#include <filesystem>
#include <string>
#include <vector>

#include "core/errors.hpp"
#include "run/files/ply_reader.hpp"
#include "run/files/point_file.hpp"
#include "run/files/text_file.hpp"
#include "tests/support/message_of.hpp"
#include "tests/support/temporary_folder.hpp"

namespace isobar::test::test_point_files {

namespace {

std::vector<MapPoint> some_points() {
  return {{{1.5, -2.25, 3.0}, {0.0F, 0.6F, 0.8F}, 7, 3},
          {{-1234.5678, 99.9994, -0.0006}, {0.0F, 0.0F, 0.0F}, 255, 0},
          {{0.25, 4.0, -8.5}, {-1.0F, 0.0F, 0.0F}, 0, 127}};
}

std::string written(const TemporaryFolder& folder, const std::string& name,
                    const std::vector<MapPoint>& points) {
  const auto file = folder.path() / name;
  const auto out = files::open_point_file(file);
  for (const MapPoint& point : points) out->add(point);
  CHECK_FALSE(std::filesystem::exists(file));  // appears as a whole
  out->close();
  return files::read_text_file(file);
}

template <typename T>
T at(const std::string& bytes, std::size_t offset) {
  T value{};
  REQUIRE(offset + sizeof(value) <= bytes.size());
  std::memcpy(&value, bytes.data() + offset, sizeof(value));
  return value;
}

float float_of(const std::string& bytes, std::size_t data, std::size_t point, std::size_t field) {
  return at<float>(bytes, data + (point * 7 + field) * sizeof(float));
}

}  // namespace

TEST_CASE("PLY has x y z nx ny nz intensity, and the reader of runs takes it") {
  const TemporaryFolder folder;
  const std::string bytes = written(folder, "map.ply", some_points());
  const std::size_t data = bytes.find("end_header\n") + 11;
  REQUIRE(bytes.size() == data + 3 * 28);
  CHECK(bytes.find("element vertex 3\n") != std::string::npos);
  CHECK(bytes.find("property float z\nproperty float nx\nproperty float ny\nproperty float nz\n"
                   "property float intensity\n") != std::string::npos);
  CHECK(float_of(bytes, data, 0, 1) == -2.25F);
  CHECK(float_of(bytes, data, 0, 5) == 0.8F);
  CHECK(float_of(bytes, data, 1, 6) == 255.0F);
  const files::PlyPoints points = files::read_ply_points(folder.path() / "map.ply", 0);
  REQUIRE(points.points.size() == 3);
  CHECK(points.points[2] == std::array<float, 3>{0.25F, 4.0F, -8.5F});
}

TEST_CASE("PCD has the fields of pcl::PointXYZINormal in a header of constant length") {
  const TemporaryFolder folder;
  const std::string bytes = written(folder, "map.PCD", some_points());
  const std::string empty = written(folder, "empty.pcd", {});
  const std::size_t data = bytes.find("DATA binary\n") + 12;
  CHECK(empty.size() == data);
  REQUIRE(bytes.size() == data + 3 * 28);
  for (const char* line :
       {"\nVERSION 0.7\n", "\nFIELDS x y z intensity normal_x normal_y normal_z\n", "\nSIZE 4 4 4 4 4 4 4\n",
        "\nTYPE F F F F F F F\n", "\nWIDTH 3\n", "\nHEIGHT 1\n", "\nPOINTS 3\n"}) {
    CHECK(bytes.find(line) != std::string::npos);
  }
  CHECK(float_of(bytes, data, 0, 3) == 7.0F);
  CHECK(float_of(bytes, data, 0, 6) == 0.8F);
  CHECK(float_of(bytes, data, 2, 4) == -1.0F);
}

// Offsets of the public header block and of point data record format 0: ASPRS, LAS Specification 1.2, tables 3 and 4.
TEST_CASE("LAS has the specification's fields at their offsets, whole millimetres and their bounding box") {
  const TemporaryFolder folder;
  const std::string bytes = written(folder, "map.las", some_points());
  REQUIRE(bytes.size() == 227 + 3 * 20);
  CHECK(bytes.substr(0, 4) == "LASF");
  CHECK(bytes[24] == 1);
  CHECK(bytes[25] == 2);
  CHECK(at<std::uint16_t>(bytes, 94) == 227);                                    // header size
  CHECK(at<std::uint32_t>(bytes, 96) == 227);                                    // offset to point data
  CHECK(at<std::uint32_t>(bytes, 100) == 0);                                     // variable length records
  CHECK(bytes[104] == 0);                                                        // point data format
  CHECK(at<std::uint16_t>(bytes, 105) == 20);                                    // record length
  CHECK(at<std::uint32_t>(bytes, 107) == 3);                                     // points
  CHECK(at<std::uint32_t>(bytes, 111) == 3);                                     // points of return 1
  CHECK(at<std::uint32_t>(bytes, 115) == 0);                                     // of return 2
  const std::vector<double> expected{0.001, 0.001,     0.001,  0.0,   0.0, 0.0,  // scales, offsets
                                     1.5,   -1234.568, 99.999, -2.25, 3.0, -8.5};
  for (std::size_t i = 0; i < expected.size(); ++i) {
    CHECK(at<double>(bytes, 131 + 8 * i) == doctest::Approx(expected[i]).epsilon(1e-12));
  }
  CHECK(at<std::int32_t>(bytes, 227) == 1500);
  CHECK(at<std::int32_t>(bytes, 227 + 4) == -2250);
  CHECK(at<std::int32_t>(bytes, 247) == -1234568);
  CHECK(at<std::int32_t>(bytes, 247 + 8) == -1);
  CHECK(at<std::uint16_t>(bytes, 247 + 12) == 65535);  // intensity, normalised
  CHECK(bytes[247 + 14] == 0b00001001);                // return 1 of 1
}

TEST_CASE("LAS of no points has an empty bounding box; a point too far away is refused") {
  const TemporaryFolder folder;
  const std::string bytes = written(folder, "empty.las", {});
  REQUIRE(bytes.size() == 227);
  CHECK(at<double>(bytes, 179) == 0.0);
  const auto file = files::open_point_file(folder.path() / "far.las");
  CHECK_THROWS_AS(file->add({{3e6, 0.0, 0.0}, {}, 0, 0}), DataError);
}

TEST_CASE("an ending that no format has is refused with the list") {
  const TemporaryFolder folder;
  for (const char* name : {"map.xyz", "map", "map.laz"}) {
    const std::string message =
        message_of([&] { static_cast<void>(files::open_point_file(folder.path() / name)); });
    CHECK(message.find("files of points end with one of .ply, .pcd, .las") != std::string::npos);
  }
  CHECK(std::filesystem::is_empty(folder.path()));
}

}  // namespace isobar::test::test_point_files
