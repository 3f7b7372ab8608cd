// SPDX-License-Identifier: BSD-3-Clause
// Asynchronous text output of VectorNav sensors: `$VNYMR,+006.380,…*checksum` (UM001 v2.22, section 5.2 and the
// register of each output; those of the VN-200 and VN-300 besides, which the same reader understands).
#pragma once

#include <optional>
#include <string_view>

#include "drivers/vn100/measurement.hpp"

namespace isobar::vn100 {

/// A line of a known text output.
struct TextMeasurement {
  std::string_view header;  ///< "VNYMR"; static
  Measurement measurement;  ///< without time: text has none
};

/// Reads a whole line (measure_line()) in the sensor's own frame, as read_packet() does. Counters and status that the
/// sensor may append (register 30, "S…", "T…", "V…", "I…") are left out. Nothing: no output of a known header,
/// another number of values, or a value that is no finite number.
[[nodiscard]] std::optional<TextMeasurement> read_text(std::string_view line) noexcept;

}  // namespace isobar::vn100
