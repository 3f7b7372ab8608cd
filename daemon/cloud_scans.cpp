// SPDX-License-Identifier: BSD-3-Clause
#include "daemon/cloud_scans.hpp"

namespace isobar {

bool CloudScans::decode(const recording::CloudRecord& cloud, Scan& scan) {
  fields_.clear();
  for (const recording::CloudRecordField& field : cloud.fields) {
    fields_.push_back({field.name, field.offset, static_cast<CloudType>(field.datatype)});
  }
  const char* rule = decoder_.decode({.fields = fields_,
                                      .width = cloud.width,
                                      .height = cloud.height,
                                      .point_step = cloud.point_step,
                                      .row_step = cloud.row_step,
                                      .is_bigendian = cloud.is_bigendian,
                                      .data = cloud.data,
                                      .stamp_ns = cloud.stamp_ns},
                                     scan);
  if (rule != nullptr) {
    if (first_rule_.empty()) first_rule_ = std::string("a cloud ") + rule;
    return false;
  }
  scan.stamp_ns += cloud.shift_ns;
  scan.end_stamp_ns += cloud.shift_ns;
  if (scans_ > 0 && scan.stamp_ns <= last_ns_) {
    ++late_;
    return false;
  }
  last_ns_ = scan.stamp_ns;
  ++scans_;
  return true;
}

std::vector<files::RunCount> CloudScans::counts() const {
  const CloudCounters& counters = decoder_.counters();
  std::vector<files::RunCount> counts;
  const auto add = [&counts](const char* name, std::uint64_t count, const std::string& first) {
    if (count > 0) counts.push_back({name, count, first});
  };
  add("lidar clouds refused", counters.refused, first_rule_);
  add("lidar clouds not later than the one before", late_, "");
  add("lidar points left out of clouds beyond 70000", counters.thinned, "");
  return counts;
}

std::string CloudScans::sentence() const { return scans_ == 0 ? std::string() : decoder_.sentence(); }

}  // namespace isobar
