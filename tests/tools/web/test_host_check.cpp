// SPDX-License-Identifier: BSD-3-Clause
#include <doctest/doctest.h>

#include <string>

#include "tools/web/host_check.hpp"

namespace isobar::test::test_host_check {

TEST_CASE("a request is served to localhost, to addresses and to the names given, whatever case and port") {
  const web::HostCheck check({"Robot7", "robot7.local"});
  for (const char* host : {"localhost", "LOCALHOST:8080", "127.0.0.1", "192.168.1.5:80", "[::1]:8080",
                           "[fe80::1]", "robot7", "ROBOT7:8080", "robot7.local:1"}) {
    CHECK_MESSAGE(check.allows(host), host);
  }
}

TEST_CASE("a request that names another host is refused: DNS rebinding") {
  const web::HostCheck check({"robot7"});
  for (const char* host :
       {"", "evil.example", "robot7.evil.example", "localhost.evil.example", "127.0.0.1.evil.example",
        "evil.example:8080", "localhost:", "localhost:80x", "localhost:123456", "[::1", "[::1]evil",
        "[::1]:", "[robot7]", "127.0.0.1:80:80", "localhost ", "127.1"}) {
    CHECK_MESSAGE(!check.allows(host), host);
  }
  CHECK(!check.allows(std::string(100'000, 'a')));
}

TEST_CASE("only the page itself is of the same origin") {
  CHECK(web::is_same_origin("http://localhost:8080", "localhost:8080"));
  CHECK(!web::is_same_origin("http://localhost:8081", "localhost:8080"));
  CHECK(!web::is_same_origin("https://localhost:8080", "localhost:8080"));
  CHECK(!web::is_same_origin("null", "localhost:8080"));
}

}  // namespace isobar::test::test_host_check
