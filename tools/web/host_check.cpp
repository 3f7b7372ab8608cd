// SPDX-License-Identifier: BSD-3-Clause
#include "tools/web/host_check.hpp"

#include <arpa/inet.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <climits>
#include <cstddef>
#include <cstdint>

namespace isobar::web {
namespace {

std::string in_lower_case(std::string_view text) {
  std::string lower(text);
  std::transform(lower.begin(), lower.end(), lower.begin(),
                 [](unsigned char letter) { return static_cast<char>(std::tolower(letter)); });
  return lower;
}

bool is_address(int family, const std::string& text) {
  std::array<std::uint8_t, 16> bytes{};
  return ::inet_pton(family, text.c_str(), bytes.data()) == 1;
}

bool is_port(std::string_view text) {
  return !text.empty() && text.size() <= 5 &&
         std::all_of(text.begin(), text.end(), [](char c) { return c >= '0' && c <= '9'; });
}

}  // namespace

HostCheck::HostCheck(const std::vector<std::string>& names) : names_{"localhost"} {
  for (const std::string& name : names) names_.insert(in_lower_case(name));
}

bool HostCheck::allows(std::string_view header) const {
  constexpr std::size_t kMostBytes = 260;  // the longest name in DNS, and a port
  if (header.empty() || header.size() > kMostBytes) return false;
  if (header.front() == '[') {
    const std::size_t end = header.find(']');
    if (end == std::string_view::npos) return false;
    const std::string_view rest = header.substr(end + 1);
    if (!rest.empty() && (rest.front() != ':' || !is_port(rest.substr(1)))) return false;
    return is_address(AF_INET6, std::string(header.substr(1, end - 1)));
  }
  const std::size_t colon = header.find(':');
  if (colon != std::string_view::npos && !is_port(header.substr(colon + 1))) return false;
  const std::string host = in_lower_case(header.substr(0, colon));
  return names_.contains(host) || is_address(AF_INET, host);
}

bool is_same_origin(std::string_view origin, std::string_view host) {
  constexpr std::string_view kScheme = "http://";
  return origin.starts_with(kScheme) && origin.substr(kScheme.size()) == host;
}

std::vector<std::string> names_of_this_machine() {
  std::array<char, HOST_NAME_MAX + 1> name{};
  if (::gethostname(name.data(), name.size() - 1) != 0 || name.front() == '\0') return {};
  return {name.data(), std::string(name.data()) + ".local"};
}

}  // namespace isobar::web
