// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <set>
#include <string>
#include <string_view>
#include <vector>

namespace isobar::web {

/// Refuses requests whose Host header names a machine that this one is not: a web page from elsewhere whose name is
/// pointed at this machine (DNS rebinding) sends its own name there. Addresses in figures are always allowed: a browser
/// that sends one was told to connect to it.
class HostCheck {
 public:
  /// @param names allowed besides "localhost", in any case
  explicit HostCheck(const std::vector<std::string>& names);
  /// @param header value of the Host header, with or without a port
  [[nodiscard]] bool allows(std::string_view header) const;

 private:
  std::set<std::string, std::less<>> names_;  ///< in lower case
};

/// True for "http://HOST" where HOST is this Host header: the Origin header of a request of the page itself.
[[nodiscard]] bool is_same_origin(std::string_view origin, std::string_view host);

/// The machine's name, alone and with ".local", as multicast DNS announces it; empty where it has none.
[[nodiscard]] std::vector<std::string> names_of_this_machine();

}  // namespace isobar::web
