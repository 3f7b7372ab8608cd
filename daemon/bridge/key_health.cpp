// SPDX-License-Identifier: BSD-3-Clause
#include "daemon/bridge/key_health.hpp"

#include <spdlog/fmt/fmt.h>

namespace isobar::bridge {

using ipc::HealthLevel;

void add_key_health(const KeyStatus& status, const AddEntry& add) {
  if (status.text.front() == '\0') return;  // not known yet
  add("bridge/keys", status.level, status.text.data(), status.days_left);
  if (!status.signs) return;
  if (status.unsigned_total > 0) {
    const bool present = status.unsigned_now > 0;
    add("bridge/keys/unsigned", present ? HealthLevel::kWarning : HealthLevel::kOk,
        present
            ? fmt::format("{} senders of base-station pressure without keys, refused", status.unsigned_now)
            : "senders of base-station pressure without keys, refused, now gone",
        static_cast<double>(status.unsigned_total));
  }
  if (status.refused.count > 0) {
    add("bridge/keys/refused", status.refused_lately ? HealthLevel::kWarning : HealthLevel::kOk,
        std::string("participants with other keys, refused: ") + status.refused.reason.data(),
        static_cast<double>(status.refused.count));
  }
}

}  // namespace isobar::bridge
