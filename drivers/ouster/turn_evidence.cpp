// SPDX-License-Identifier: BSD-3-Clause
#include "drivers/ouster/turn_evidence.hpp"

#include <algorithm>

namespace isobar::ouster {

void TurnEvidence::add(const Span& packet) {
  doubt_ -= doubt_ > 0 ? 1 : 0;
  const bool beyond = packet.last_id >= columns_;
  const bool early = begins_early(packet);
  if (beyond || early) {
    const std::uint32_t seen = (early ? last_.last_id : packet.last_id) + 1;
    seen_columns_ = doubt_ > 0 ? std::max(seen_columns_, seen) : seen;
    doubt_ = kPacketsOfDoubt;
  }
  have_last_ = true;
  last_ = packet;
}

/// The step from the packet before, backwards in the id, takes the time of the columns up to the turn's end and
/// those after it; less than half of it is no such step. Pace by the packet before.
bool TurnEvidence::begins_early(const Span& packet) const {
  const bool is_step_back = have_last_ && packet.first_id < last_.last_id && packet.first_ns > last_.last_ns;
  if (!is_step_back || last_.last_id >= columns_ || last_.last_id <= last_.first_id) return false;
  const std::int64_t step = std::int64_t{columns_} - last_.last_id + packet.first_id;
  if (step < columns_ / 4) return false;
  const double column_ns = static_cast<double>(last_.last_ns - last_.first_ns) /
                           static_cast<double>(last_.last_id - last_.first_id);
  return static_cast<double>(packet.first_ns - last_.last_ns) < 0.5 * column_ns * static_cast<double>(step);
}

}  // namespace isobar::ouster
