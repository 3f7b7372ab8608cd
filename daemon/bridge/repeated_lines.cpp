// SPDX-License-Identifier: BSD-3-Clause
#include "daemon/bridge/repeated_lines.hpp"

#include <algorithm>
#include <cctype>

namespace isobar::bridge {
namespace {

std::string printable_line(std::string_view line) {
  std::string text(line.substr(0, RepeatedLines::kMaxLineBytes));
  std::replace_if(
      text.begin(), text.end(), [](unsigned char c) { return c < ' ' || c >= 0x7f; }, '?');
  return text;
}

/// The line without its numbers, hexadecimal ones included.
std::string kind_of(const std::string& line) {
  std::string kind;
  std::copy_if(line.begin(), line.end(), std::back_inserter(kind),
               [](unsigned char c) { return std::isxdigit(c) == 0; });
  return kind;
}

}  // namespace

std::optional<std::string> RepeatedLines::note(std::string_view line, std::int64_t now_ns) {
  std::string text = printable_line(line);
  const std::lock_guard lock(mutex_);
  std::string kind = kind_of(text);
  if (kinds_.size() >= kMaxKinds && kinds_.find(kind) == kinds_.end()) {
    kind.clear();
    text = "lines of further kinds";
  }
  if (now_ns - last_ns_ >= kQuietNs) period_ns_ = kPeriodNs;
  last_ns_ = now_ns;
  const auto [known, is_new] = kinds_.try_emplace(kind, Kind{text, now_ns, 0});
  known->second.last_ns = now_ns;
  if (is_new) return text;
  if (count_++ == 0) since_ns_ = now_ns;
  ++known->second.count;
  return std::nullopt;
}

std::optional<std::string> RepeatedLines::due(std::int64_t now_ns) {
  const std::lock_guard lock(mutex_);
  if (count_ == 0) {
    std::erase_if(kinds_, [now_ns](const auto& known) { return now_ns - known.second.last_ns >= kForgetNs; });
    return std::nullopt;
  }
  if (now_ns - since_ns_ < period_ns_) return std::nullopt;
  std::string text = text_of_counts(now_ns);
  for (auto& known : kinds_) known.second.count = 0;
  count_ = 0;
  period_ns_ = std::min(4 * period_ns_, kLongestPeriodNs);
  return text;
}

std::string RepeatedLines::text_of_counts(std::int64_t now_ns) const {
  const auto kinds =
      std::count_if(kinds_.begin(), kinds_.end(), [](const auto& known) { return known.second.count > 0; });
  const auto most = std::max_element(kinds_.begin(), kinds_.end(), [](const auto& a, const auto& b) {
    return a.second.count < b.second.count;
  });
  std::string text =
      std::to_string(count_) + " more in " + std::to_string((now_ns - since_ns_) / 1'000'000'000) + " s";
  if (kinds > 1) {
    text += " of " + std::to_string(kinds) + " kinds, " + std::to_string(most->second.count) + " of them";
  }
  return text + ": " + most->second.line;
}

}  // namespace isobar::bridge
