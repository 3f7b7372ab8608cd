// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <cstdint>
#include <string>
#include <vector>

namespace isobar::test {

/// Serialises the fields of a message, as ROS 1 or as CDR of either byte order; written without the readers' code.
class MessageBuilder {
 public:
  enum class Form : std::uint8_t { kRos1, kCdrLittle, kCdrBig };
  explicit MessageBuilder(Form form) : form_(form) {
    if (form == Form::kCdrLittle) head_ = std::string("\0\1\0\0", 4);
    if (form == Form::kCdrBig) head_ = std::string(4, '\0');
  }
  template <typename Value>
  MessageBuilder& add(Value value) {
    while (form_ != Form::kRos1 && bytes_.size() % sizeof(Value) != 0) bytes_ += '\0';
    std::string bytes(reinterpret_cast<const char*>(&value), sizeof(Value));
    if (form_ == Form::kCdrBig) std::reverse(bytes.begin(), bytes.end());
    bytes_ += bytes;
    return *this;
  }
  MessageBuilder& text(const std::string& text) {
    const bool ends = form_ != Form::kRos1;
    add(static_cast<std::uint32_t>(text.size() + (ends ? 1 : 0)));
    bytes_ += text;
    if (ends) bytes_ += '\0';
    return *this;
  }
  MessageBuilder& raw(const std::string& bytes) {
    bytes_ += bytes;
    return *this;
  }
  MessageBuilder& blob(const std::string& bytes) {
    add(static_cast<std::uint32_t>(bytes.size()));
    return raw(bytes);
  }
  MessageBuilder& time(std::int64_t ns) {
    add(static_cast<std::uint32_t>(ns / 1'000'000'000));
    return add(static_cast<std::uint32_t>(ns % 1'000'000'000));
  }
  MessageBuilder& header(std::int64_t ns, const std::string& frame) {
    if (form_ == Form::kRos1) add(std::uint32_t{7});
    return time(ns).text(frame);
  }
  MessageBuilder& doubles(const std::vector<double>& values) {
    for (const double value : values) add(value);
    return *this;
  }
  [[nodiscard]] std::string bytes() const { return head_ + bytes_; }

 private:
  Form form_;
  std::string head_;
  std::string bytes_;
};

using Form = MessageBuilder::Form;
inline const std::vector<Form> kForms{Form::kRos1, Form::kCdrLittle, Form::kCdrBig};

/// @param attitude x, y, z, w
inline std::string imu_message(Form form, std::int64_t ns, const std::string& frame,
                               const std::vector<double>& attitude, const std::vector<double>& gyro,
                               const std::vector<double>& accel) {
  return MessageBuilder(form)
      .header(ns, frame)
      .doubles(attitude)
      .doubles(std::vector<double>(9, 0.01))
      .doubles(gyro)
      .doubles(std::vector<double>(9, 0.0))
      .doubles(accel)
      .doubles(std::vector<double>(9, 0.0))
      .bytes();
}

inline std::string pressure_message(Form form, std::int64_t ns, const std::string& frame, double pressure,
                                    double variance) {
  return MessageBuilder(form).header(ns, frame).doubles({pressure, variance}).bytes();
}

inline std::string transform_message(Form form, const std::string& parent, const std::string& child,
                                     const std::vector<double>& pose) {
  return MessageBuilder(form).add(std::uint32_t{1}).header(0, parent).text(child).doubles(pose).bytes();
}

struct TestPoint {
  float x, y, z;
  float time_s;
  std::uint16_t ring;
};

/// A cloud of x, y, z, time, ring.
inline std::string cloud_message(Form form, std::int64_t ns, const std::string& frame,
                                 const std::vector<TestPoint>& points) {
  MessageBuilder builder(form);
  builder.header(ns, frame).add(std::uint32_t{1}).add(static_cast<std::uint32_t>(points.size()));
  builder.add(std::uint32_t{5});
  const auto field = [&](const std::string& name, std::uint32_t offset, std::uint8_t type) {
    builder.text(name).add(offset).add(type).add(std::uint32_t{1});
  };
  field("x", 0, 7);
  field("y", 4, 7);
  field("z", 8, 7);
  field("time", 12, 7);
  field("ring", 16, 4);
  builder.add(std::uint8_t{0}).add(std::uint32_t{18}).add(static_cast<std::uint32_t>(18 * points.size()));
  std::string data;
  for (const TestPoint& point : points) {
    data.append(reinterpret_cast<const char*>(&point), 16);
    data.append(reinterpret_cast<const char*>(&point.ring), 2);
  }
  return builder.blob(data).add(std::uint8_t{1}).bytes();
}

}  // namespace isobar::test
