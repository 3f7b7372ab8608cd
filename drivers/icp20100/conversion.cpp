// SPDX-License-Identifier: BSD-3-Clause
#include "drivers/icp20100/conversion.hpp"

#include <algorithm>

#include "drivers/barometer/bits.hpp"
#include "drivers/barometer/operating_range.hpp"

namespace isobar::icp20100 {

RawResult decode_result(std::span<const std::uint8_t, kResultBytes> bytes) noexcept {
  return {signed_field(little_u24(bytes, 0), 20), signed_field(little_u24(bytes, 3), 20)};
}

Converted convert(const RawResult& raw) noexcept {
  return {raw.pressure / 131'072.0 * 40e3 + 70e3, raw.temperature / 262'144.0 * 65.0 + 25.0};
}

const char* implausibility(const RawResult& raw, const Converted& value) noexcept {
  if (raw.pressure == 0 && raw.temperature == 0) return "no result in the registers";
  return outside_operation(value.pressure_pa, value.temperature_c);
}

const Mode& mode_of(int rate_hz) noexcept {
  const auto* const mode =
      std::find_if(kModes.begin(), kModes.end(), [rate_hz](const Mode& m) { return m.rate_hz == rate_hz; });
  return mode == kModes.end() ? kModes.front() : *mode;
}

double white_variance_pa2(const Mode& mode) noexcept {
  return mode.noise_pa * mode.noise_pa * 0.5 * mode.rate_hz / mode.bandwidth_hz;
}

}  // namespace isobar::icp20100
