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
  const auto [known, is_new] = kinds_.try_emplace(kind, Kind{text, now_ns, 0});
  if (is_new) return text;
  ++known->second.count;
  return std::nullopt;
}

std::vector<std::string> RepeatedLines::due(std::int64_t now_ns) {
  std::vector<std::string> lines;
  const std::lock_guard lock(mutex_);
  for (auto known = kinds_.begin(); known != kinds_.end();) {
    Kind& kind = known->second;
    if (now_ns - kind.since_ns < kPeriodNs) {
      ++known;
    } else if (kind.count == 0) {
      known = kinds_.erase(known);  // silent for a period: its next line is a first one
    } else {
      lines.push_back(std::to_string(kind.count) + " more in " +
                      std::to_string((now_ns - kind.since_ns) / 1'000'000'000) + " s: " + kind.line);
      kind.since_ns = now_ns;
      kind.count = 0;
      ++known;
    }
  }
  return lines;
}

}  // namespace isobar::bridge
