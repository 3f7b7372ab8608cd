// SPDX-License-Identifier: BSD-3-Clause
#include "run/text/text_source.hpp"

#include <algorithm>

namespace isobar::text {
namespace {

constexpr std::size_t kRawBytes = std::size_t{32} * 1024;
constexpr std::size_t kLongestUtf8 = 4;
constexpr std::uint32_t kReplacement = 0xFFFD;  // for halves of surrogate pairs

bool is_high_surrogate(std::uint32_t unit) { return unit >= 0xD800 && unit < 0xDC00; }
bool is_low_surrogate(std::uint32_t unit) { return unit >= 0xDC00 && unit < 0xE000; }

}  // namespace

TextSource::TextSource(const std::filesystem::path& file) : file_(file) {
  if (file_.head().starts_with("\xFF\xFE")) encoding_ = Encoding::kUtf16Little;
  if (file_.head().starts_with("\xFE\xFF")) encoding_ = Encoding::kUtf16Big;
  // Without a byte order mark: every second byte of Latin letters is 0.
  const std::string_view head = file_.head();
  if (head.size() >= 4 && head[0] == 0 && head[1] != 0 && head[2] == 0) encoding_ = Encoding::kUtf16Big;
  if (head.size() >= 4 && head[0] != 0 && head[1] == 0 && head[3] == 0) encoding_ = Encoding::kUtf16Little;
  if (encoding_ != Encoding::kBytes) raw_.resize(kRawBytes);
}

std::uint32_t TextSource::unit_at(std::size_t index) const {
  const auto byte = [&](std::size_t at) {
    return static_cast<std::uint32_t>(static_cast<unsigned char>(raw_[at]));
  };
  const std::uint32_t first = byte(2 * index);
  const std::uint32_t second = byte(2 * index + 1);
  return encoding_ == Encoding::kUtf16Little ? first | second << 8U : first << 8U | second;
}

bool TextSource::fill() {
  const std::size_t count = file_.read(raw_.data() + raw_count_, raw_.size() - raw_count_);
  raw_count_ += count;
  return count > 0;
}

std::size_t TextSource::put_utf8(std::uint32_t code, char* to) {
  const auto put = [&](std::size_t at, std::uint32_t bits) { to[at] = static_cast<char>(bits); };
  const auto tail = [&](unsigned shift) { return 0x80U | (code >> shift & 0x3FU); };
  if (code < 0x80) {
    put(0, code);
    return 1;
  }
  if (code < 0x800) {
    put(0, 0xC0U | code >> 6U);
    put(1, tail(0));
    return 2;
  }
  if (code < 0x10000) {
    put(0, 0xE0U | code >> 12U);
    put(1, tail(6));
    put(2, tail(0));
    return 3;
  }
  put(0, 0xF0U | code >> 18U);
  put(1, tail(12));
  put(2, tail(6));
  put(3, tail(0));
  return 4;
}

std::size_t TextSource::read(char* to, std::size_t size) {
  if (encoding_ == Encoding::kBytes) return file_.read(to, size);
  std::size_t written = 0;
  while (written == 0) {
    const bool more = fill();
    std::size_t unit = 0;
    const std::size_t units = raw_count_ / 2;
    for (; unit < units && written + kLongestUtf8 <= size; ++unit) {
      std::uint32_t code = unit_at(unit);
      if (is_high_surrogate(code)) {
        if (unit + 1 == units && more) break;  // its other half has not come
        if (unit + 1 < units && is_low_surrogate(unit_at(unit + 1))) {
          code = 0x10000 + ((code - 0xD800) << 10U) + (unit_at(++unit) - 0xDC00);
        }
      }
      if (code >= 0xD800 && code < 0xE000) code = kReplacement;
      written += put_utf8(code, to + written);
    }
    std::copy(raw_.begin() + static_cast<std::ptrdiff_t>(2 * unit),
              raw_.begin() + static_cast<std::ptrdiff_t>(raw_count_), raw_.begin());
    raw_count_ -= 2 * unit;
    if (!more && written == 0) return 0;
  }
  return written;
}

bool TextSource::skip_to_last(std::uint64_t bytes, std::uint64_t unread) {
  if (encoding_ == Encoding::kBytes) return file_.skip_to_last(bytes, unread);
  // The file's size may be odd where it is cut; without a seek every row to the end is read instead.
  return false;
}

}  // namespace isobar::text
