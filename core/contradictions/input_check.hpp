// SPDX-License-Identifier: BSD-3-Clause
// All detectors of contradictions behind one door: samples in, findings out.
//
//   imu ───▶ GravityCheck ─────────────────────────────┐
//   imu ───▶ gyro's turns ──┐                           ├─▶ Findings ─▶ UsableSensors
//   wheels ▶ wheels' motion ─┼─▶ turn, way, clock ──────┤
//   scans ─▶ ScanMotion ─────┘    verdicts              │
//   barometers ─▶ PressureSeconds ─▶ swap ──────────────┘
#pragma once

#include <Eigen/Core>
#include <memory>

#include "core/contradictions/finding.hpp"
#include "core/contradictions/stream_times.hpp"
#include "core/geometry.hpp"
#include "core/samples.hpp"

namespace isobar {

/// Configured mounts of the sensors that are checked.
struct InputCheckConfig {
  Mount imu;
  Mount lidar;
};

/// Takes samples in any order between sensors, each sensor's in order of time. Allocates in its constructor only.
/// Deterministic. Not thread-safe.
class InputCheck {
 public:
  explicit InputCheck(const InputCheckConfig& config);
  ~InputCheck();
  InputCheck(const InputCheck&) = delete;
  InputCheck& operator=(const InputCheck&) = delete;

  void add_imu(const ImuSample& sample);
  void add_wheel(const WheelSample& sample);
  void add_pressure(const PressureSample& sample);
  void add_base_pressure(const PressureSample& sample);
  void add_scan(const Scan& scan);

  /// What all samples so far say; some 0.1 ms for a minute of samples. Later samples may take a finding back.
  [[nodiscard]] Findings find() const;
  /// Clocks that are apart by the turns: 100 ms for twenty minutes.
  void add_clocks(Findings& findings) const;
  /// Streams without a common time. For whole recordings: of a live run, a sensor may come later than another goes.
  void add_overlaps(Findings& findings) const;
  /// Twenty minutes are over: later samples add nothing.
  [[nodiscard]] bool full() const;
  /// Two of the sensors that feel turns have been compared.
  [[nodiscard]] bool turns_known() const;
  [[nodiscard]] const StreamTimes& times(CheckedSensor sensor) const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace isobar
