// SPDX-License-Identifier: BSD-3-Clause
#include <doctest/doctest.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <string>

#include "core/errors.hpp"
#include "tools/web/token.hpp"

namespace isobar::test::test_token {

namespace {

namespace fs = std::filesystem;

const std::string kSecret = "0123456789abcdefABCDEF";

struct TokenFile {
  fs::path path = fs::temp_directory_path() / ("isobar-token-" + std::to_string(::getpid()));
  TokenFile(const std::string& content, unsigned mode) {
    std::ofstream(path) << content;
    fs::permissions(path, static_cast<fs::perms>(mode));
  }
  ~TokenFile() { fs::remove(path); }
  TokenFile(const TokenFile&) = delete;
  TokenFile& operator=(const TokenFile&) = delete;
};

}  // namespace

TEST_CASE("only the whole token after Bearer matches") {
  const web::Token token(kSecret, "token");
  CHECK(token.matches("Bearer " + kSecret));
  for (const std::string& wrong :
       {std::string(), kSecret, std::string("Bearer "), "bearer " + kSecret, "Bearer " + kSecret + "x",
        "Bearer  " + kSecret, "Bearer " + kSecret.substr(1),
        "Bearer " + kSecret.substr(0, kSecret.size() - 1), "Basic " + kSecret,
        "Bearer " + std::string(300, '0'), "Bearer " + kSecret + std::string(1, '\0')}) {
    CHECK_MESSAGE(!token.matches(wrong), wrong);
  }
}

TEST_CASE("a token is read from a file that other users cannot open") {
  CHECK(web::Token::read(TokenFile(kSecret + "\n", 0600).path).matches("Bearer " + kSecret));
  CHECK(web::Token::read(TokenFile(kSecret + "\r\nsecond line", 0640).path).matches("Bearer " + kSecret));
  for (const unsigned mode : {0644U, 0620U, 0601U}) {
    CHECK_THROWS_AS((void)web::Token::read(TokenFile(kSecret, mode).path), ConfigError);
  }
}

TEST_CASE("a token that is short, long or not printable is refused, and so is a missing file") {
  for (const std::string& bad : {std::string(), std::string("short"), std::string(257, 'a'),
                                 "with a blank in " + kSecret, kSecret + "\x01"}) {
    CHECK_THROWS_AS(web::Token(bad, "token"), ConfigError);
  }
  CHECK_THROWS_AS((void)web::Token::read("/nonexistent/token"), ConfigError);
}

}  // namespace isobar::test::test_token
