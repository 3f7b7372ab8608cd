// SPDX-License-Identifier: BSD-3-Clause
// What Cyclone DDS says about participants that DDS security refuses, as a count instead of lines.
#pragma once

#include <array>
#include <cstdint>
#include <string_view>

namespace isobar::dds {

/// Refusals of other participants: plain values, trivially copyable.
struct RefusedMembers {
  std::uint64_t count = 0;         ///< failed handshakes; who is refused tries again every second
  std::array<char, 160> reason{};  ///< of the last one, as the library states it; null-terminated
};

/// Counts a line of the library's log if it is about a refusal. Any thread.
/// @return true when it was, or says nothing: it is not to be logged, because a stranger could fill the log
bool note_refusal(std::string_view line) noexcept;

[[nodiscard]] RefusedMembers refused_members() noexcept;

}  // namespace isobar::dds
