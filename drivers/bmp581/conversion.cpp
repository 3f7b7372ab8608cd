// SPDX-License-Identifier: BSD-3-Clause
#include "drivers/bmp581/conversion.hpp"

#include <algorithm>

#include "drivers/barometer/operating_range.hpp"

namespace isobar::bmp581 {

RawResult decode_result(std::span<const std::uint8_t, kDataBytes> bytes) noexcept {
  return {signed_field(little_u24(bytes, 0), 24), little_u24(bytes, 3)};
}

Converted convert(const RawResult& raw) noexcept { return {raw.pressure / 64.0, raw.temperature / 65'536.0}; }

const char* implausibility(const RawResult& raw, const Converted& value) noexcept {
  if (raw.pressure == kNoResult || raw.temperature == static_cast<std::int32_t>(kNoResult)) {
    return "no result in the registers";
  }
  return outside_operation(value.pressure_pa, value.temperature_c);
}

std::uint8_t rate_code(int rate_hz) noexcept {
  const auto* const rate =
      std::find_if(kRates.begin(), kRates.end(), [rate_hz](const Rate& r) { return r.hz == rate_hz; });
  return rate == kRates.end() ? kRates.front().code : rate->code;
}

}  // namespace isobar::bmp581
