// SPDX-License-Identifier: BSD-3-Clause
// Clouds as the drivers of several makers lay them out.
#include <doctest/doctest.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>
#include <functional>
#include <limits>
#include <memory>
#include <string>
#include <vector>

#include "drivers/cloud/cloud_decoder.hpp"

namespace isobar::test::test_cloud_decoder {
namespace {

constexpr std::int64_t kStampNs = 1'700'000'000'123'456'000;
constexpr int kPoints = 2'000;
constexpr double kScanS = 0.0999;

struct FieldPlan {
  std::string name;
  CloudType type;
};

double zero(const std::string&, double, int) { return 0.0; }

/// Points on a circle, laser by laser or in the order of firing, with values of extra fields by time [s] and laser.
struct CloudPlan {
  std::vector<FieldPlan> fields{
      {"x", CloudType::kFloat32}, {"y", CloudType::kFloat32}, {"z", CloudType::kFloat32}};
  std::uint32_t height = 1;
  std::uint32_t row_padding = 0;
  bool is_bigendian = false;
  std::function<double(const std::string&, double time_s, int laser)> value = &zero;
};

class Cloud {
 public:
  explicit Cloud(const CloudPlan& plan) : plan_(plan) {
    std::uint32_t offset = 0;
    for (const FieldPlan& field : plan_.fields) {
      fields.push_back({field.name, offset, field.type});
      offset += static_cast<std::uint32_t>(size_of(field.type));
    }
    view.width = kPoints / plan_.height;
    view.height = plan_.height;
    view.point_step = offset + 4;  // padding
    view.row_step = view.width * view.point_step + plan_.row_padding;
    view.is_bigendian = plan_.is_bigendian;
    view.stamp_ns = kStampNs;
    data.resize(std::size_t{view.row_step} * view.height);
    for (std::uint32_t row = 0; row < view.height; ++row) {
      for (std::uint32_t column = 0; column < view.width; ++column) write_point(row, column);
    }
    view.fields = fields;
    view.data = data;
  }
  Cloud(const Cloud&) = delete;
  Cloud& operator=(const Cloud&) = delete;

  std::vector<CloudField> fields;
  std::vector<std::uint8_t> data;
  CloudView view;

 private:
  void write_point(std::uint32_t row, std::uint32_t column) {
    // Organised: a row is a laser, all of the same times. Else one laser after the other fires.
    const std::uint32_t index = row * view.width + column;
    const bool organised = view.height > 1;
    const double time_s = kScanS * (organised ? column / (view.width - 1.0) : index / (kPoints - 1.0));
    const int laser = static_cast<int>(organised ? row : index % 16);
    std::uint8_t* at = data.data() + std::size_t{row} * view.row_step + std::size_t{column} * view.point_step;
    for (const CloudField& field : fields) {
      const std::string name(field.name);
      const double angle = 60.0 * time_s;
      const double value = name == "x"   ? 5.0 * std::cos(angle)
                           : name == "y" ? 5.0 * std::sin(angle)
                           : name == "z" ? 0.2 * laser - 1.5
                                         : plan_.value(name, time_s, laser);
      write(at + field.offset, field.type, value);
    }
  }
  template <class Value>
  void put(std::uint8_t* at, Value value) const {
    std::memcpy(at, &value, sizeof value);
    if (plan_.is_bigendian) std::reverse(at, at + sizeof value);
  }
  void write(std::uint8_t* at, CloudType type, double value) const {
    switch (type) {
      case CloudType::kInt8:
        return put(at, static_cast<std::int8_t>(value));
      case CloudType::kUint8:
        return put(at, static_cast<std::uint8_t>(value));
      case CloudType::kInt16:
        return put(at, static_cast<std::int16_t>(value));
      case CloudType::kUint16:
        return put(at, static_cast<std::uint16_t>(value));
      case CloudType::kInt32:
        return put(at, static_cast<std::int32_t>(value));
      case CloudType::kUint32:
        return put(at, static_cast<std::uint32_t>(value));
      case CloudType::kFloat32:
        return put(at, static_cast<float>(value));
      case CloudType::kFloat64:
        return put(at, value);
    }
  }

  CloudPlan plan_;
};

CloudPlan with(std::vector<FieldPlan> extra, std::function<double(const std::string&, double, int)> value) {
  CloudPlan plan;
  plan.fields.insert(plan.fields.end(), extra.begin(), extra.end());
  plan.value = std::move(value);
  return plan;
}

struct Decoded {
  std::unique_ptr<Scan> scan = std::make_unique<Scan>();
  CloudDecoder decoder;
  const char* rule = nullptr;
};

Decoded decode(const Cloud& cloud, const LidarLimits& limits = {}) {
  Decoded decoded;
  decoded.decoder.set_limits(limits);
  decoded.rule = decoded.decoder.decode(cloud.view, *decoded.scan);
  return decoded;
}

}  // namespace

TEST_CASE("Times in every unit, number type and reference that drivers use give the same scan") {
  struct Form {
    const char* name;
    CloudType type;
    double per_s;     // units in a second
    double from_s;    // value of the first point
    double exact_us;  // resolution of the type in this form
  };
  const double stamp_s = 1'700'000'000.123456;
  for (const Form& form : {
           Form{"time", CloudType::kFloat32, 1.0, 0.0, 1.0},           // Velodyne's ROS driver
           Form{"time", CloudType::kFloat32, 1.0, -kScanS, 1.0},       // the stamp is the end of the scan
           Form{"t", CloudType::kUint32, 1e9, 0.0, 1.0},               // Ouster
           Form{"offset_time", CloudType::kUint32, 1e9, 0.0, 1.0},     // Livox
           Form{"timestamp", CloudType::kFloat64, 1.0, stamp_s, 1.0},  // Hesai, RoboSense
           Form{"timestamp", CloudType::kFloat64, 1e9, stamp_s, 1.0},  // Livox
           Form{"timestamp", CloudType::kFloat64, 1e6, stamp_s, 1.0},
           Form{"time_stamp", CloudType::kUint32, 1e6, 0.0, 1.0},
           Form{"t", CloudType::kInt32, 1e6, -kScanS, 1.0},
           Form{"time", CloudType::kFloat32, 1e3, 0.0, 1.0},
       }) {
    CAPTURE(form.name);
    CAPTURE(form.per_s);
    CAPTURE(form.from_s);
    const Cloud cloud(with({{form.name, form.type}, {"ring", CloudType::kUint16}},
                           [&](const std::string& field, double time_s, int laser) {
                             return field == "ring" ? laser : (form.from_s + time_s) * form.per_s;
                           }));
    const Decoded decoded = decode(cloud);
    REQUIRE(decoded.rule == nullptr);
    const CloudFormat& format = decoded.decoder.format();
    CHECK(format.time == form.name);
    CHECK(format.time_unit_s == doctest::Approx(1.0 / form.per_s));
    CHECK(format.is_absolute == (form.from_s > 1.0));
    const double before_s = form.from_s < 0.0 ? form.from_s : 0.0;
    const Scan& scan = *decoded.scan;
    CHECK(std::abs(scan.stamp_ns - (kStampNs + std::llround(before_s * 1e9))) <= 1'000);
    CHECK(std::abs(scan.end_stamp_ns - scan.stamp_ns - std::llround(kScanS * 1e9)) <= 4'000);
    REQUIRE(scan.point_count == kPoints);
    for (int i = 0; i < kPoints; i += 100) {
      // Half a unit of ScanPoint, and the type's resolution.
      CHECK(std::abs(scan.points[i].time_4us * 4.0 - kScanS * i / (kPoints - 1.0) * 1e6) <=
            2.0 + form.exact_us);
      CHECK(scan.points[i].ring == i % 16);
    }
  }
}

TEST_CASE("Organised clouds, which come laser by laser, are put in the order of firing") {
  CloudPlan plan = with({{"t", CloudType::kUint32}, {"ring", CloudType::kUint8}},
                        [](const std::string& field, double time_s, int laser) {
                          return field == "ring" ? laser : time_s * 1e9;
                        });
  plan.height = 16;
  plan.row_padding = 12;
  const Cloud cloud(plan);
  const Decoded decoded = decode(cloud);
  REQUIRE(decoded.rule == nullptr);
  REQUIRE(decoded.scan->point_count == kPoints);
  CHECK(std::is_sorted(decoded.scan->points, decoded.scan->points + kPoints,
                       [](const ScanPoint& a, const ScanPoint& b) { return a.time_4us < b.time_4us; }));
  for (int i = 0; i < 16; ++i) CHECK(decoded.scan->points[i].ring == i);  // the first column
}

TEST_CASE("Big-endian clouds hold the same points") {
  CloudPlan plan =
      with({{"time", CloudType::kFloat64}, {"intensity", CloudType::kFloat32}},
           [](const std::string& field, double time_s, int) { return field == "time" ? time_s : 77.4; });
  const Cloud little(plan);
  plan.is_bigendian = true;
  const Cloud big(plan);
  const Decoded a = decode(little);
  const Decoded b = decode(big);
  REQUIRE(a.scan->point_count == kPoints);
  REQUIRE(b.scan->point_count == kPoints);
  CHECK(std::memcmp(a.scan->points, b.scan->points, kPoints * sizeof(ScanPoint)) == 0);
  CHECK(a.scan->points[0].intensity == 77);
}

TEST_CASE("Missing times, rings and intensities are allowed, and said with their cost") {
  const Cloud cloud(CloudPlan{});
  const Decoded decoded = decode(cloud);
  REQUIRE(decoded.rule == nullptr);
  CHECK(decoded.scan->point_count == kPoints);
  CHECK(decoded.scan->stamp_ns == kStampNs);
  CHECK(decoded.scan->end_stamp_ns == kStampNs);
  CHECK(decoded.decoder.sentence() ==
        "points without times: scans are not deskewed, fast turns blur the map; no ring: lasers are told by "
        "their elevation; no intensity");
  // Higher lasers have higher stand-ins.
  CHECK(decoded.scan->points[15].ring > decoded.scan->points[0].ring);
}

TEST_CASE(
    "A time field without times counts as none; absolute times of another clock keep their differences") {
  const Cloud constant(with({{"time", CloudType::kFloat32}}, &zero));
  CHECK(decode(constant).decoder.format().time.empty());
  const Cloud since_boot(with({{"timestamp", CloudType::kFloat64}},
                              [](const std::string&, double time_s, int) { return 500.0 + time_s; }));
  const Decoded decoded = decode(since_boot);
  CHECK(decoded.decoder.format().is_absolute);
  CHECK(decoded.scan->stamp_ns == kStampNs);
  CHECK(decoded.scan->end_stamp_ns - kStampNs == doctest::Approx(kScanS * 1e9).epsilon(1e-3));
}

TEST_CASE("No returns, near and masked points are left out") {
  CloudPlan plan;
  const Cloud cloud(plan);
  std::vector<std::uint8_t> data = cloud.data;
  const float nan = std::numeric_limits<float>::quiet_NaN();
  const float zero = 0.0F;
  std::memcpy(data.data(), &nan, 4);
  for (int i = 0; i < 3; ++i) std::memcpy(data.data() + cloud.view.point_step + 4 * i, &zero, 4);
  CloudView view = cloud.view;
  view.data = data;
  const auto scan = std::make_unique<Scan>();
  CloudDecoder decoder;
  REQUIRE(decoder.decode(view, *scan) == nullptr);
  CHECK(scan->point_count == kPoints - 2);
  CHECK(decoder.counters().no_return == 2);
  LidarLimits limits;
  limits.mask_start_deg = 90.0;  // clockwise: the right half
  limits.mask_end_deg = 180.0;
  decoder.set_limits(limits);
  REQUIRE(decoder.decode(view, *scan) == nullptr);
  for (std::uint32_t i = 0; i < scan->point_count; ++i) {
    const bool behind_right = scan->points[i].x_m < -1e-3 && scan->points[i].y_m < -1e-3;
    CHECK_FALSE(behind_right);
  }
  CHECK(scan->point_count < kPoints * 0.8);
}

TEST_CASE("Messages that break a rule are refused with the rule, and give no point") {
  const auto rule_of = [](const auto& change) {
    const CloudPlan plan;
    Cloud cloud(plan);
    change(cloud);
    cloud.view.fields = cloud.fields;
    const auto scan = std::make_unique<Scan>();
    CloudDecoder decoder;
    const char* rule = decoder.decode(cloud.view, *scan);
    CHECK(scan->point_count == 0);
    CHECK(decoder.counters().refused == (rule != nullptr ? 1 : 0));
    return std::string(rule != nullptr ? rule : "");
  };
  CHECK(rule_of([](Cloud& c) { c.view.width = 0; }) == "holds no point");
  CHECK(rule_of([](Cloud& c) { c.view.width = 0xFFFF'FFFF; }) == "data is shorter than its points");
  CHECK(rule_of([](Cloud& c) { c.view.data = c.view.data.first(c.view.data.size() - 1); }) ==
        "data is shorter than its points");
  CHECK(rule_of([](Cloud& c) {
          c.view.height = 2;
          c.view.row_step = 8;
        }) == "point_step and row_step do not fit the width");
  CHECK(rule_of([](Cloud& c) { c.view.point_step = 0; }) == "point_step and row_step do not fit the width");
  CHECK(rule_of([](Cloud& c) { c.fields[2].name = "zz"; }) == "has no fields x, y and z");
  CHECK(rule_of([](Cloud& c) { c.fields[2].offset = 0xFFFF'FFFF; }) == "a field lies beyond point_step");
  CHECK(rule_of([](Cloud& c) { c.fields[1].type = static_cast<CloudType>(9); }) ==
        "a field has an unknown datatype");
}

}  // namespace isobar::test::test_cloud_decoder
