// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <atomic>
#include <cstdint>
#include <cstring>
#include <type_traits>

namespace isobar {

/// Sequence lock: the newest value of one writer thread for any number of reader threads. The writer never
/// waits; a reader retries when a write interferes. The words are atomics, so there is no data race (H.-J.
/// Boehm, "Can seqlocks get along with programming language memory models?", 2012).
template <class T>
class SeqLock {
  static_assert(std::is_trivially_copyable_v<T>);
  static constexpr std::size_t kWords = (sizeof(T) + 7) / 8;

 public:
  SeqLock() { put(T{}); }

  /// Writer thread only.
  void put(const T& value) noexcept {
    std::array<std::uint64_t, kWords> words{};
    std::memcpy(words.data(), &value, sizeof(T));
    const std::uint32_t before = sequence_.load(std::memory_order_relaxed);
    sequence_.store(before + 1, std::memory_order_relaxed);
    // Release order: a reader that sees a new word also sees the odd sequence number.
    for (std::size_t i = 0; i < kWords; ++i) words_[i].store(words[i], std::memory_order_release);
    sequence_.store(before + 2, std::memory_order_release);
  }

  /// Any thread.
  [[nodiscard]] T get() const noexcept {
    std::array<std::uint64_t, kWords> words{};
    for (;;) {
      const std::uint32_t before = sequence_.load(std::memory_order_acquire);
      for (std::size_t i = 0; i < kWords; ++i) words[i] = words_[i].load(std::memory_order_acquire);
      if ((before & 1U) == 0U && sequence_.load(std::memory_order_relaxed) == before) break;
    }
    T value{};
    std::memcpy(static_cast<void*>(&value), words.data(), sizeof(T));
    return value;
  }

 private:
  std::atomic<std::uint32_t> sequence_{0};
  std::array<std::atomic<std::uint64_t>, kWords> words_{};
};

}  // namespace isobar
