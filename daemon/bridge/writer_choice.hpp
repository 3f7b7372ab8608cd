// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>

namespace isobar::bridge {

/// One writer of a DDS topic, so that two drivers, or a driver and a stranger, are never mixed. The first heard is
/// used. Another one takes over at once when the one in use has ended, and after 5 s of its silence. One thread.
class WriterChoice {
 public:
  /// As SenderLock::kTakeoverNs.
  static constexpr std::int64_t kTakeoverNs = 5'000'000'000;

  /// Whether a good sample of this writer is used.
  /// @param writer handle of the writer, not 0
  /// @param now_ns time of arrival, monotonic
  /// @param is_present tells whether the writer with this handle still exists
  template <class IsPresent>
  bool admits(std::uint64_t writer, std::int64_t now_ns, const IsPresent& is_present) {
    const bool is_free = in_use_ == 0 || now_ns - heard_ns_ > kTakeoverNs;
    if (writer != in_use_ && !is_free && is_present(in_use_)) {
      ++refused_;
      return false;
    }
    in_use_ = writer;
    heard_ns_ = now_ns;
    return true;
  }
  /// Samples of other writers.
  [[nodiscard]] std::uint64_t refused() const noexcept { return refused_; }

 private:
  std::uint64_t in_use_ = 0;
  std::int64_t heard_ns_ = 0;
  std::uint64_t refused_ = 0;
};

}  // namespace isobar::bridge
