// SPDX-License-Identifier: BSD-3-Clause
#include "drivers/setra278/span.hpp"

#include <cmath>

namespace isobar::setra278 {

const char* broken_rule(const Span& span) noexcept {
  if (!(span.high_v > span.low_v)) return "high_v must be above low_v";
  if (!(span.high_pa > span.low_pa)) return "high_pa must be above low_pa";
  return nullptr;
}

Reading pressure_of(const Span& span, double volts) noexcept {
  const double share = (volts - span.low_v) / (span.high_v - span.low_v);
  if (!std::isfinite(share)) return {"no voltage", 0.0};
  if (share <= kEndShare) return {"voltage at or below the span: wire open, or no supply?", 0.0};
  if (share >= 1.0 - kEndShare) return {"voltage at or above the span: saturated, or shorted?", 0.0};
  return {nullptr, span.low_pa + share * (span.high_pa - span.low_pa)};
}

}  // namespace isobar::setra278
