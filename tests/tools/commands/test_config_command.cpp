// SPDX-License-Identifier: BSD-3-Clause
#include <doctest/doctest.h>

#include <string>
#include <vector>

#include "run/files/text_file.hpp"
#include "tests/support/exit_code.hpp"
#include "tests/support/temporary_folder.hpp"
#include "tools/commands.hpp"

namespace isobar::test::test_config_command {

namespace {

int config(std::vector<std::string> words) {
  words.insert(words.begin(), "config");
  return isobar::test::exit_code(tools::add_config_command, std::move(words));
}

}  // namespace

TEST_CASE("isobar config ends with 0 for a valid file, 78 for a bad one and 64 for a wrong call") {
  const TemporaryFolder folder;
  const std::string good = (folder.path() / "good.toml").string();
  const std::string bad = (folder.path() / "bad.toml").string();
  files::write_text_file(good, "dds.domain_id = 7\n");
  files::write_text_file(bad, "dds.domain_id = 233\n");
  CHECK(config({"check", good}) == 0);
  CHECK(config({"check", bad}) == 78);
  CHECK(config({"show", good, "--basic"}) == 0);
  CHECK(config({"show", bad}) == 78);
  CHECK(config({"show", "--role", "base-station", "--basic"}) == 0);
  CHECK(config({"show", "--role", "drone"}) == 64);
  CHECK(config({}) == 64);
}

TEST_CASE("isobar config check lists every error; seal makes a file that shows when it is cut") {
  const TemporaryFolder folder;
  const std::string file = (folder.path() / "a.toml").string();
  files::write_text_file(file, "dds.domain_id = 7\n");
  CHECK(config({"seal", file}) == 0);
  CHECK(config({"seal", (folder.path() / "none").string()}) == 78);
  files::write_text_file(file, "dds.domain_id = 233\nlidar.port = 0\n");
  CHECK(config({"check", file}) == 78);
}

TEST_CASE("isobar config init writes a file that checks, and overwrites nothing") {
  const TemporaryFolder folder;
  const std::string root = folder.path().string();
  const std::string file = (folder.path() / "isobar.toml").string();
  CHECK(config({"init", file, "--root", root, "--listen", "0"}) == 0);
  CHECK(config({"check", file}) == 0);
  CHECK(config({"init", file, "--root", root, "--listen", "0"}) == 69);
}

}  // namespace isobar::test::test_config_command
