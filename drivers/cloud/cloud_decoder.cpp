// SPDX-License-Identifier: BSD-3-Clause
#include "drivers/cloud/cloud_decoder.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <initializer_list>
#include <limits>

#include "core/geometry.hpp"

namespace isobar {
namespace {

/// Shortest and longest time from the first to the last point of a scan [s].
constexpr double kShortestScanS = 0.005;
constexpr double kLongestScanS = 0.26;
/// Times from here on count from an epoch or a start, not from the stamp of their cloud [s].
constexpr double kLeastAbsoluteS = 10.0;
/// Largest difference of absolute times to the header's stamp [s]; farther ones count on another clock.
constexpr double kMostApartS = 1.0;
constexpr std::array<double, 4> kUnitsS{1.0, 1e-3, 1e-6, 1e-9};

std::optional<CloudField> find(const CloudView& cloud, std::initializer_list<std::string_view> names) {
  for (const std::string_view name : names) {
    const auto field = std::find_if(cloud.fields.begin(), cloud.fields.end(),
                                    [name](const CloudField& f) { return f.name == name; });
    if (field != cloud.fields.end()) return *field;
  }
  return std::nullopt;
}

std::size_t points_of(const CloudView& cloud) { return std::size_t{cloud.width} * cloud.height; }

/// Point `index`, rows with their padding.
const std::uint8_t* point_at(const CloudView& cloud, std::size_t index) {
  const std::size_t row = index / cloud.width;
  return cloud.data.data() + row * cloud.row_step + (index - row * cloud.width) * cloud.point_step;
}

/// Stand-in for the number of a laser: its elevation in steps of 2 deg.
std::uint8_t ring_of_elevation(float x, float y, float z) {
  const double elevation_deg = std::atan2(z, std::hypot(x, y)) / kRadPerDeg;
  return static_cast<std::uint8_t>(std::clamp(elevation_deg / 2.0 + 45.0, 0.0, 90.0));
}

std::uint8_t ring_of_value(double value) {
  constexpr double kMostRings = 255.0;
  return value >= 0.0 && value <= kMostRings ? static_cast<std::uint8_t>(value) : std::uint8_t{0};
}

}  // namespace

const char* CloudDecoder::decode(const CloudView& cloud, Scan& scan) {
  scan.point_count = 0;
  scan.packets_lost = 0;
  Fields fields;
  if (const char* rule = check(cloud, fields); rule != nullptr) {
    ++counters_.refused;
    return rule;
  }
  const Times times = fields.time ? times_of(cloud, *fields.time) : Times{};
  format_.ring = fields.ring ? std::string(fields.ring->name) : std::string{};
  format_.intensity = fields.intensity ? std::string(fields.intensity->name) : std::string{};
  format_.time = times.known ? std::string(fields.time->name) : std::string{};
  format_.time_unit_s = times.unit_s;
  format_.is_absolute = times.known && std::abs(times.first * times.unit_s) >= kLeastAbsoluteS;
  scan.stamp_ns = times.known ? times.first_ns : cloud.stamp_ns;
  scan.end_stamp_ns = scan.stamp_ns;
  add_points(cloud, fields, times, scan);
  scan.sequence = static_cast<std::uint32_t>(counters_.clouds++);
  counters_.points += scan.point_count;
  return nullptr;
}

const char* CloudDecoder::check(const CloudView& cloud, Fields& fields) const {
  if (cloud.width == 0 || cloud.height == 0) return "holds no point";
  const std::size_t row_bytes = std::size_t{cloud.width} * cloud.point_step;
  const std::size_t row_step = cloud.row_step;
  if (cloud.point_step == 0 || (cloud.height > 1 && row_step < row_bytes)) {
    return "point_step and row_step do not fit the width";
  }
  if ((cloud.height - 1) * row_step + row_bytes > cloud.data.size()) return "data is shorter than its points";
  for (const CloudField& field : cloud.fields) {
    const std::size_t size = size_of(field.type);
    if (size == 0) return "a field has an unknown datatype";
    if (field.offset + size > cloud.point_step) return "a field lies beyond point_step";
  }
  const auto x = find(cloud, {"x"});
  const auto y = find(cloud, {"y"});
  const auto z = find(cloud, {"z"});
  if (!x || !y || !z) return "has no fields x, y and z";
  fields = {*x,
            *y,
            *z,
            find(cloud, {"ring", "line", "channel", "laser_id"}),
            find(cloud, {"time", "t", "timestamp", "time_stamp", "offset_time", "time_offset", "timestamps",
                         "stamp"}),
            find(cloud, {"intensity", "reflectivity", "i"})};
  return nullptr;
}

CloudDecoder::Times CloudDecoder::times_of(const CloudView& cloud, const CloudField& field) const {
  Times times;
  double last = -std::numeric_limits<double>::infinity();
  times.first = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < points_of(cloud); ++i) {
    const double value = value_of(point_at(cloud, i), field, cloud.is_bigendian);
    if (!std::isfinite(value)) continue;
    times.first = std::min(times.first, value);
    last = std::max(last, value);
  }
  const double span = last - times.first;
  for (const double unit_s : kUnitsS) {
    if (span * unit_s >= kShortestScanS && span * unit_s <= kLongestScanS) times.unit_s = unit_s;
  }
  if (times.unit_s == 0.0) return {};
  times.known = true;
  const double first_s = times.first * times.unit_s;
  const double stamp_s = static_cast<double>(cloud.stamp_ns) * 1e-9;
  if (std::abs(first_s) < kLeastAbsoluteS) {
    times.first_ns = cloud.stamp_ns + std::llround(first_s * 1e9);
  } else if (std::abs(first_s - stamp_s) <= kMostApartS) {
    // To 1 us: a double of the epoch in seconds is exact to 0.2 us.
    times.first_ns = std::llround(first_s * 1e6) * 1'000;
  } else {
    times.first_ns = cloud.stamp_ns;  // another clock: the stamp is that of the first point
  }
  return times;
}

void CloudDecoder::add_points(const CloudView& cloud, const Fields& fields, const Times& times, Scan& scan) {
  const std::size_t count = points_of(cloud);
  const std::size_t step = (count + Scan::kMaxPoints - 1) / Scan::kMaxPoints;
  bool in_order = true;
  std::uint16_t newest = 0;
  for (std::size_t i = 0; i < count; i += step) {
    const std::uint8_t* at = point_at(cloud, i);
    const auto coordinate = [&](const CloudField& field) {
      return static_cast<float>(value_of(at, field, cloud.is_bigendian));
    };
    ScanPoint& point = scan.points[scan.point_count];
    point.x_m = coordinate(fields.x);
    point.y_m = coordinate(fields.y);
    point.z_m = coordinate(fields.z);
    if (!is_kept(point.x_m, point.y_m, point.z_m)) continue;
    point.time_4us = 0;
    if (times.known) {
      const double since_s = (value_of(at, *fields.time, cloud.is_bigendian) - times.first) * times.unit_s;
      point.time_4us = std::isfinite(since_s) ? point_time(std::llround(since_s * 1e9)) : std::uint16_t{0};
    }
    point.ring = fields.ring ? ring_of_value(value_of(at, *fields.ring, cloud.is_bigendian))
                             : ring_of_elevation(point.x_m, point.y_m, point.z_m);
    const double intensity = fields.intensity ? value_of(at, *fields.intensity, cloud.is_bigendian) : 0.0;
    point.intensity =
        static_cast<std::uint8_t>(std::isfinite(intensity) ? std::clamp(intensity, 0.0, 255.0) : 0.0);
    in_order = in_order && point.time_4us >= newest;
    newest = std::max(newest, point.time_4us);
    ++scan.point_count;
  }
  counters_.thinned += count - (count + step - 1) / step;
  scan.end_stamp_ns = scan.stamp_ns + newest * kPointTimeUnitNs;
  if (in_order) return;
  // The sampling of a scan goes by the order of firing; organised clouds come laser by laser.
  std::stable_sort(scan.points, scan.points + scan.point_count,
                   [](const ScanPoint& a, const ScanPoint& b) { return a.time_4us < b.time_4us; });
}

bool CloudDecoder::is_kept(float x, float y, float z) {
  const double range_m = std::hypot(static_cast<double>(x), y, z);
  if (!std::isfinite(range_m) || range_m < limits_.min_range_m || range_m <= 0.0) {
    ++counters_.no_return;
    return false;
  }
  if (range_m > limits_.max_range_m) return false;
  if (limits_.mask_start_deg == limits_.mask_end_deg) return true;
  const auto within = [](double degrees) { return degrees - 360.0 * std::floor(degrees / 360.0); };
  const double clockwise_deg = within(-std::atan2(y, x) / kRadPerDeg);
  return within(clockwise_deg - limits_.mask_start_deg) >=
         within(limits_.mask_end_deg - limits_.mask_start_deg);
}

std::string CloudDecoder::sentence() const {
  std::string text;
  if (format_.time.empty()) {
    text = "points without times: scans are not deskewed, fast turns blur the map";
  } else {
    const char* unit = format_.time_unit_s == 1.0    ? "s"
                       : format_.time_unit_s == 1e-3 ? "ms"
                       : format_.time_unit_s == 1e-6 ? "us"
                                                     : "ns";
    text = "times from " + format_.time + " in " + unit +
           (format_.is_absolute ? ", absolute" : ", relative to the stamp");
  }
  text +=
      format_.ring.empty() ? "; no ring: lasers are told by their elevation" : "; rings from " + format_.ring;
  if (format_.intensity.empty()) text += "; no intensity";
  return text;
}

}  // namespace isobar
