// SPDX-License-Identifier: BSD-3-Clause
#include "daemon/bridge/cloud_input.hpp"

#include <spdlog/spdlog.h>

#include <cstring>

#include "drivers/clock/robot_clock.hpp"
#include "ipc/dds/messages.hpp"

namespace isobar::bridge {
namespace {

/// A cloud message without copying its points. The names are those of the message.
CloudView view_of(const dds::CloudMessage& message, std::vector<CloudField>& fields) {
  fields.clear();
  for (std::uint32_t i = 0; i < message.fields._length; ++i) {
    const auto& field = message.fields._buffer[i];
    fields.push_back({field.name == nullptr ? std::string_view{} : std::string_view(field.name), field.offset,
                      static_cast<CloudType>(field.datatype)});
  }
  return {.fields = fields,
          .width = message.width,
          .height = message.height,
          .point_step = message.point_step,
          .row_step = message.row_step,
          .is_bigendian = message.is_bigendian,
          .data = {message.data._buffer, message.data._length},
          .stamp_ns = dds::to_stamp_ns(message.header.stamp)};
}

}  // namespace

CloudInput::CloudInput(dds_entity_t participant, const Settings& settings)
    : reader_(participant, dds::topics::kPoints, settings.dds.ros_namespace, settings.dds.topics.points,
              settings.dds.input_qos.points),
      publisher_(ipc::topics::kLidarScan),
      decoder_(settings.lidar_limits) {}

void CloudInput::take(std::int64_t now_ns, const SystemClockWatch& system_clock) {
  reader_.take([&](const dds::CloudMessage& message, dds_instance_handle_t writer) {
    const auto is_present = [&](dds_instance_handle_t other) { return reader_.is_matched(other); };
    if (writer_.admits(writer, monotonic_ns(), is_present)) {
      convert(message, now_ns, system_clock);
    } else {
      other_senders_.fetch_add(1, std::memory_order_relaxed);
    }
  });
}

void CloudInput::drop() {
  refused_.fetch_add(static_cast<std::uint64_t>(reader_.take([](const dds::CloudMessage&) {})),
                     std::memory_order_relaxed);
}

void CloudInput::convert(const dds::CloudMessage& message, std::int64_t now_ns,
                         const SystemClockWatch& system_clock) {
  Scan* scan = publisher_.loan();
  if (scan == nullptr) return refuse("shared memory has no free chunk");
  if (const char* rule = decoder_.decode(view_of(message, fields_), *scan); rule != nullptr) {
    publisher_.discard(scan);
    return refuse(rule);
  }
  if (!has_said_ || !(decoder_.format() == said_)) {
    said_ = decoder_.format();
    has_said_ = true;
    spdlog::info("lidar clouds: {}", decoder_.sentence());
  }
  // The sender's clock is that of another machine, or this machine's system clock, which can step. A cloud is
  // sent after its last point.
  const std::int64_t length_ns = scan->end_stamp_ns - scan->stamp_ns;
  const std::int64_t end_ns = sender_clock_.without_steps_ns(scan->end_stamp_ns, now_ns - anchor_.offset_ns(),
                                                             anchored_, system_clock);
  static_cast<void>(anchor_.add(end_ns, now_ns));
  anchored_ = true;
  scan->end_stamp_ns = anchor_.to_host_ns(anchor_.device_unwrapped_ns());
  scan->stamp_ns = scan->end_stamp_ns - length_ns;
  scan->timing = {now_ns, anchor_.device_ahead_ns()};
  publisher_.publish(scan);
}

void CloudInput::refuse(const char* rule) {
  refused_.fetch_add(1, std::memory_order_relaxed);
  if (said_rule_ == rule) return;
  said_rule_ = rule;
  spdlog::warn("lidar clouds: a cloud is refused: {}", rule);
}

}  // namespace isobar::bridge
