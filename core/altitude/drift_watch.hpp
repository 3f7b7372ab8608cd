// SPDX-License-Identifier: BSD-3-Clause
// A drift of a barometer against the height that other sensors know, told from zones, doors and weather by its shape.
//
//     residual e = altimeter - height,   D = change of e along the line through a window,   L = D's window
//
// A ventilated zone (1 to 4 Pa, 8 to 33 cm) is a step, a door a pulse, turbulence has no direction; a drift is a line. So
// a window drifts when D exceeds what air and the height's own error explain, when the residuals lie on the line, and
// when no fifth of the window makes half of D. Six windows, because 5 Pa/s are half a metre a second, and 0.01 Pa/s a
// decimetre in two minutes. The air's unrest is measured meanwhile, from what is no line.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "core/estimates.hpp"

namespace isobar {

/// Watches the residuals of one altimeter. Measured on simulated buildings and hills: 5 Pa/s are named after 4 s, 1 Pa/s
/// after 8 s, 0.25 Pa/s after 9 to 16 s. Of the zones, doors and gusts of 33 runs two were taken for a drift while it was
/// tuned.
class DriftWatch {
 public:
  struct Reading {
    std::int64_t stamp_ns = 0;
    double residual_m = 0.0;  ///< altimeter minus height by other means, without steps of the reference
    double base_m = 0.0;      ///< the base station's part of it (Prior::base_air_m)
    double way_m = 0.0;       ///< way since the reading before, on which the height itself may err
    double airflow_sd_m =
        0.0;            ///< of the robot's own wind, as far as it is not known: it changes with the speed
    bool base = false;  ///< against a base station: the weather cancels
  };

  /// The next reading, in order of time. A gap begins a new watch.
  void add(const Reading& reading);
  /// The height is not known (a ride), another reference or clock.
  void restart() { *this = DriftWatch(); }

  /// Barometer that drifts now; kUnknown: one of both.
  [[nodiscard]] DriftSuspect suspect() const { return suspect_; }
  /// Rate of the drift [m/s]; 0 without one.
  [[nodiscard]] double rate_m_s() const { return rate_m_s_; }

 private:
  static constexpr double kBinS = 0.5;
  static constexpr std::size_t kParts = 10;  // of a window
  static constexpr std::size_t kBins = 320;  // of the longest window, 160 s
  static constexpr double kLeastUnrestM2 = 4e-4;
  struct Bin {
    double residual_m = 0.0;  // means
    double base_m = 0.0;
    double way_m = 0.0;  // sum
    double airflow_sd_m = 0.0;
  };
  struct Window {
    std::array<double, kParts> residual_m{};
    std::array<double, kParts> base_m{};
    double way_m = 0.0;
    double airflow_sd_m = 0.0;  // range of the bins' one: the unknown airflow that is no offset
  };

  void close();
  void learn_unrest();
  void judge();
  [[nodiscard]] double steps_m(std::size_t length, double rate_m_s) const;
  [[nodiscard]] const Bin& back(std::size_t age) const { return bins_[(next_ + kBins - 1 - age) % kBins]; }
  [[nodiscard]] Window window(std::size_t bins_a_part) const;

  std::array<Bin, kBins> bins_{};  // ring
  std::size_t next_ = 0;
  std::size_t count_ = 0;
  Bin open_;  // sums
  int open_count_ = 0;
  std::int64_t open_ns_ = 0;
  std::int64_t last_ns_ = 0;
  double unrest_m2_ = kLeastUnrestM2;  // variance of the turbulence
  bool base_ = false;
  DriftSuspect suspect_ = DriftSuspect::kNone;
  double rate_m_s_ = 0.0;
  int quiet_bins_ = 0;  // bins without a drift since the last one with it
};

}  // namespace isobar
