// SPDX-License-Identifier: BSD-3-Clause
// Units of a topic's values by the values: messages state units that their senders do not always keep to.
#pragma once

#include <string>
#include <vector>

namespace isobar::tools {

struct UnitGuess {
  double scale = 1.0;  ///< factor to SI
  std::string text;    ///< "Pa", "hPa, converted" …
  bool is_certain = true;
};

/// The median; NaN of none. Reorders the values.
[[nodiscard]] double median_of(std::vector<double>& values);

/// @param chosen "m/s2", "g", "mg", or empty
/// @param norms of the specific force, at rest and in motion: their median is about one g
/// @throws UsageError for another word
[[nodiscard]] UnitGuess guess_accel_unit(const std::string& chosen, std::vector<double> norms);

/// @param chosen "rad/s", "deg/s", or empty
/// @param rates norms of the angular rate
/// @param attitude_turn turn of the IMU's own attitude over the same time [rad]; 0: it has none
/// @param rate_turn integral of the rates [in their unit times s]
/// @throws UsageError for another word
[[nodiscard]] UnitGuess guess_gyro_unit(const std::string& chosen, std::vector<double> rates,
                                        double attitude_turn, double rate_turn);

/// @param chosen "Pa", "hPa", "kPa", or empty
/// @throws UsageError for another word
[[nodiscard]] UnitGuess guess_pressure_unit(const std::string& chosen, std::vector<double> values);

}  // namespace isobar::tools
