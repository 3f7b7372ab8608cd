// SPDX-License-Identifier: BSD-3-Clause
// Fuzz target: what a request of the page brings: line 1 the Host header, line 2 Authorization, then the body of a hint. A
// host that is allowed holds nothing that a name or an address cannot, and a hint that is taken is plausible.
#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <string>
#include <string_view>

#include "ipc/pose_hint.hpp"
#include "tools/web/action_desk.hpp"
#include "tools/web/host_check.hpp"
#include "tools/web/token.hpp"

namespace {

std::string_view take_line(std::string_view& rest) {
  const std::string_view line = rest.substr(0, rest.find('\n'));
  rest.remove_prefix(std::min(rest.size(), line.size() + 1));
  return line;
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace isobar;
  static const web::HostCheck hosts({"robot7", "robot7.local"});
  static const std::string secret = "0123456789abcdef";
  static const web::Token token(secret, "token");
  std::string_view rest(reinterpret_cast<const char*>(data), size);
  const std::string_view host = take_line(rest);
  if (hosts.allows(host) && host.find_first_of("/@?# \t\r\\") != std::string_view::npos) std::abort();
  const std::string_view authorization = take_line(rest);
  if (token.matches(authorization) != (authorization == "Bearer " + secret)) std::abort();
  std::string reason;
  const auto hint = web::parse_hint(rest, reason);
  if (hint.has_value() != reason.empty()) std::abort();
  if (hint && ipc::implausibility(*hint) != nullptr) std::abort();
  return 0;
}
