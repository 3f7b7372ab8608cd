// SPDX-License-Identifier: BSD-3-Clause
#include <doctest/doctest.h>

#include <CLI/CLI.hpp>
#include <cstdlib>
#include <string>
#include <vector>

#include "core/errors.hpp"
#include "tools/dds_options.hpp"

namespace isobar::test::test_dds_options {

using namespace isobar::tools;

namespace {

/// Whether the parser takes the words; what it read goes into `options`.
bool takes(const std::vector<std::string>& words, DdsOptions& options) {
  CLI::App app;
  add_dds_options(app, options);
  try {
    app.parse(std::vector<std::string>(words.rbegin(), words.rend()));
  } catch (const CLI::ParseError&) {
    return false;
  }
  return true;
}

bool takes(const std::vector<std::string>& words) {
  DdsOptions options;
  return takes(words, options);
}

}  // namespace

TEST_CASE("a domain that DDS does not have and a namespace that ROS does not have are refused") {
  CHECK(takes({"--domain", "232", "--namespace", "site/robot1"}));
  CHECK_FALSE(takes({"--domain", "233"}));
  CHECK_FALSE(takes({"--domain", "x"}));
  CHECK_FALSE(takes({"--namespace", "a b"}));
  CHECK_FALSE(takes({"--namespace", "1robot"}));
  CHECK_FALSE(takes({"--namespace", "/robot"}));
}

TEST_CASE("the domain is ROS_DOMAIN_ID's where none is given, and checked in the same way") {
  DdsOptions options;
  setenv("ROS_DOMAIN_ID", "7", 1);  // NOLINT(concurrency-mt-unsafe): one thread
  CHECK(takes({}, options));
  CHECK(options.domain == 7);
  CHECK(takes({"--domain", "8"}, options));
  CHECK(options.domain == 8);
  setenv("ROS_DOMAIN_ID", "abc", 1);  // NOLINT(concurrency-mt-unsafe)
  CHECK_FALSE(takes({}, options));
  unsetenv("ROS_DOMAIN_ID");  // NOLINT(concurrency-mt-unsafe)
}

TEST_CASE("an interface that is not there is an error that names it") {
  CHECK_THROWS_WITH_AS((void)join_dds({199, "nosuch0", ""}),
                       "no network interface that is up has the name or address nosuch0", ServiceError);
}

}  // namespace isobar::test::test_dds_options
