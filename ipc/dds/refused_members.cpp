// SPDX-License-Identifier: BSD-3-Clause
#include "ipc/dds/refused_members.hpp"

#include <algorithm>
#include <mutex>

namespace isobar::dds {
namespace {

std::mutex g_refusals_mutex;
RefusedMembers g_refusals;

/// Parts of the lines about a participant, writer or reader that is refused, in Cyclone DDS 0.10.2.
constexpr std::array<std::string_view, 4> kRefusals{"handshake", "alidate remote identity",
                                                    "remote identity failed", "not allowed by security"};
/// Of a line without meaning: a member was heard of before the own participant was complete.
constexpr std::string_view kTransient = "Remote secure participant";

/// The library adds codes and file names of OpenSSL behind the reason.
std::string_view reason_of(std::string_view line) { return line.substr(0, line.find("(code:")); }

}  // namespace

bool note_refusal(std::string_view line) noexcept {
  if (line.starts_with(kTransient)) return true;
  const bool is_refusal = std::any_of(kRefusals.begin(), kRefusals.end(), [line](std::string_view part) {
    return line.find(part) != std::string_view::npos;
  });
  if (!is_refusal) return false;
  const std::string_view reason = reason_of(line);
  const std::lock_guard lock(g_refusals_mutex);
  ++g_refusals.count;
  const std::size_t length = std::min(reason.size(), g_refusals.reason.size() - 1);
  g_refusals.reason.fill('\0');
  // A certificate's subject is the stranger's text.
  std::transform(reason.begin(), reason.begin() + static_cast<std::ptrdiff_t>(length),
                 g_refusals.reason.begin(), [](char c) { return c >= ' ' && c <= '~' ? c : '?'; });
  return true;
}

RefusedMembers refused_members() noexcept {
  const std::lock_guard lock(g_refusals_mutex);
  return g_refusals;
}

}  // namespace isobar::dds
