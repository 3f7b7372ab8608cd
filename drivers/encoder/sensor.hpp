// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <string>

#include "drivers/device/fault_watch.hpp"
#include "drivers/encoder/edge_source.hpp"
#include "drivers/encoder/settings.hpp"

namespace isobar::encoder {

/// Wheel odometry from quadrature encoders. A sample is the mean twist of one period of the rate, by the
/// kernel's stamps of the edges; its stamp is the middle of that period. Standing wheels give zeros at the
/// same rate.
///
/// Edges are read at every step: the kernel holds 16 a line, so that step() must follow file_descriptor(). While
/// edges come they are read every kReadEveryNs instead, since a thread that each edge wakes would fill a core; the
/// descriptor is then -1.
/// Lost edges that are noticed, and full queues, count as `corrupt`.
class Sensor final : public Device<WheelSample> {
 public:
  /// A line of 32 kHz fills its queue in this time.
  static constexpr std::int64_t kReadEveryNs = 500'000;

  Sensor(const Settings& settings, std::unique_ptr<EdgeSource> source);

  Step step(std::int64_t now_ns) noexcept override;
  [[nodiscard]] int file_descriptor() const noexcept override;
  [[nodiscard]] const DeviceStatus& status() const noexcept override { return faults_.status(); }
  [[nodiscard]] const std::string& place() const noexcept override { return place_; }

  /// Count of an encoder since construction, forward positive.
  /// @param encoder index in Settings::encoders()
  [[nodiscard]] std::int64_t count(std::size_t encoder) const noexcept { return decoders_[encoder].count(); }

 private:
  std::int64_t begin(std::int64_t now_ns) noexcept;
  void measure(std::int64_t now_ns, Step& step) noexcept;
  void take(std::int64_t now_ns, Step& step) noexcept;
  /// Mean count of the encoders of a side in the period that ends.
  [[nodiscard]] double side_counts(std::size_t first) const noexcept;

  std::array<EncoderLines, kMaxEncoders> encoders_;
  Geometry geometry_;
  std::int64_t period_ns_;
  std::unique_ptr<EdgeSource> source_;
  std::string place_;
  FaultWatch faults_;
  EdgeSorter sorter_;
  std::array<QuadratureDecoder, kMaxEncoders> decoders_;
  std::array<std::int64_t, kMaxEncoders> last_counts_{};  ///< at the end of the last period
  std::int64_t period_end_ns_ = 0;                        ///< of the period in progress, clock of the edges
  bool open_ = false;
  bool turns_ = false;  ///< the last step has read edges
};

}  // namespace isobar::encoder
