// SPDX-License-Identifier: BSD-3-Clause
#include <doctest/doctest.h>

#include <string>
#include <utility>
#include <vector>

#include "run/files/text_file.hpp"
#include "tests/support/exit_code.hpp"
#include "tests/support/temporary_folder.hpp"
#include "tools/commands.hpp"

namespace isobar::test::test_evaluate_command {

using isobar::test::TemporaryFolder;

namespace {

int exit_code(std::vector<std::string> words) {
  return isobar::test::exit_code(tools::add_evaluate_command, std::move(words));
}

}  // namespace

TEST_CASE("isobar evaluate writes report and figures, and each mistake has its exit code") {
  const TemporaryFolder folder;
  const auto path = [&](const char* name) { return (folder.path() / name).string(); };
  std::string walk;
  for (int i = 0; i < 100; ++i) walk += std::to_string(i) + " " + std::to_string(0.2 * i) + " 0 0 0 0 0 1\n";
  files::write_text_file(path("r.tum"), walk);
  files::write_text_file(path("bad.tum"), "1 2 3\n");
  files::write_text_file(path("bad.csv"), "t_start_ns,label\n");

  CHECK(exit_code({"evaluate", path("r.tum"), path("r.tum"), "--names", "walk", "--report", path("out.html"),
                   "--json", path("out.json"), "--align", "rigid"}) == 0);
  const std::string html = files::read_text_file(path("out.html"));
  CHECK(html.find("--align rigid") != std::string::npos);
  CHECK(html.find("walk") != std::string::npos);
  CHECK(files::read_text_file(path("out.json")).find("\"name\": \"walk\"") != std::string::npos);

  CHECK(exit_code({"evaluate"}) == 64);
  CHECK(exit_code({"evaluate", path("r.tum")}) == 64);
  CHECK(exit_code({"evaluate", path("r.tum"), path("r.tum"), "--names", "a,b"}) == 64);
  CHECK(exit_code({"evaluate", path("r.tum"), path("r.tum"), "--align", "sideways"}) == 64);
  CHECK(exit_code({"evaluate", path("r.tum"), path("none.tum")}) == 65);
  CHECK(exit_code({"evaluate", path("bad.tum"), path("r.tum")}) == 65);
  CHECK(exit_code({"evaluate", folder.path().string(), path("r.tum")}) == 65);
  CHECK(exit_code({"evaluate", path("r.tum"), path("r.tum"), "--segments", path("bad.csv")}) == 65);
  CHECK(exit_code({"evaluate", path("r.tum"), path("r.tum"), "--report", path("no/such/folder.html")}) == 64);
}

}  // namespace isobar::test::test_evaluate_command
