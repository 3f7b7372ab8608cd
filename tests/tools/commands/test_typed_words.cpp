// SPDX-License-Identifier: BSD-3-Clause
#include <doctest/doctest.h>

#include <CLI/CLI.hpp>
#include <string>
#include <vector>

#include "config/config_layer.hpp"
#include "core/errors.hpp"
#include "core/nearest_word.hpp"
#include "tests/support/temporary_folder.hpp"
#include "tools/commands.hpp"
#include "tools/number_option.hpp"
#include "tools/output_option.hpp"
#include "tools/overridden_settings.hpp"
#include "tools/typed_words.hpp"

namespace isobar::test::test_typed_words {

using namespace isobar::tools;

namespace {

/// What is said about a command line; empty: nothing.
std::string said(const std::vector<std::string>& words) {
  CLI::App app("x", "isobar");
  app.require_subcommand(1);
  add_replay_command(app);
  add_evaluate_command(app);
  add_map_command(app);
  add_calibrate_command(app);
  try {
    check_typed_words(app, words);
  } catch (const UsageError& error) {
    return error.what();
  }
  return {};
}

}  // namespace

TEST_CASE("the nearest word is the one with the fewest letters off, and none where all are far") {
  const std::vector<std::string> known{"replay", "record", "reset", "4dof", "6dof"};
  CHECK(nearest_word("replya", known) == "replay");
  CHECK(nearest_word("recrod", known) == "record");
  CHECK(nearest_word("4dofs", known) == "4dof");
  CHECK(nearest_word("zzzz", known).empty());
  CHECK(nearest_word("", known).empty());
  CHECK(nearest_word(std::string(10'000, 'r'), known).empty());
  CHECK(edit_distance("kitten", "sitting") == 3);  // the textbook's example
}

TEST_CASE("a command that is typed wrong is named with the one that was meant, at every level") {
  CHECK(said({"replya", "x"}) ==
        "replya: no such command; did you mean isobar replay?; `isobar --help` shows all");
  CHECK(said({"map", "exprot"}) ==
        "exprot: no such command; did you mean isobar map export?; `isobar map --help` shows all");
  CHECK(said({"zzzzzzzz"}) == "zzzzzzzz: no such command; `isobar --help` shows all");
  CHECK(said({"calibrate", "mount"}).find("did you mean isobar calibrate mounts?") != std::string::npos);
}

TEST_CASE("an option that is typed wrong is named, with and without a value behind it") {
  CHECK(
      said({"replay", "x", "--methd", "4dof"}) ==
      "--methd: isobar replay has no such option; did you mean --method?; `isobar replay --help` shows all");
  CHECK(said({"replay", "--methd=4dof"}).starts_with("--methd: isobar replay has no such option"));
}

TEST_CASE(
    "what the parser knows passes: options, values, negative numbers, words behind --, optional "
    "subcommands") {
  CHECK(said({"replay", "--method", "4dof", "replya", "--out=map"}).empty());
  CHECK(said({"evaluate", "a", "-3", "--", "--methd"}).empty());
  CHECK(said({"calibrate", "--sensor", "a.csv"}).empty());
  CHECK(said({"calibrate", "mounts"}).empty());
  CHECK(said({"--help"}).empty());
  CHECK(said({}).empty());
}

TEST_CASE("a bad number is named in one short line") {
  CHECK(number_from_zero()("abc") == "\"abc\" is no number");
  CHECK(number_from_zero()("-4") == "-4 is not at least 0");
  CHECK(number_above_zero()("0") == "0 is not above 0");
  CHECK(number_within(0.5, 1e6)("0.4") == "0.4 is not within 0.5 \u2026 1000000");
  CHECK(number_within(0.5, 1e6)("nan") == "\"nan\" is no number");
  CHECK(number_within(0.5, 1e6)("0.5").empty());
  CHECK(number_within(0, 9)("1e400").size() < 60);
}

TEST_CASE("a file is refused whose ending names another format than the one that is written") {
  CHECK(written_as({".html", ".htm"})("r.pdf") ==
        "r.pdf: is written as .html or .htm, and its name must end so");
  CHECK(written_as({".html"})("report") == "report: is written as .html, and its name must end so");
  CHECK(written_as({".html"})("a.b.HTML").empty());
}

TEST_CASE("a file is refused in a folder that is not there, before any work is done for it") {
  const TemporaryFolder folder;
  const std::string missing = folder.path() / "no" / "r.html";
  CHECK(written_as({".html"})(missing) ==
        missing + ": there is no folder " + (folder.path() / "no").string());
  CHECK(written_as({".html"})((folder.path() / "r.html").string()).empty());
  CHECK_THROWS_WITH_AS(require_path(missing, "a report"),
                       (missing + ": no such file or folder; expected is a report").c_str(), DataError);
}

TEST_CASE("what the parser refuses is one line that names the command whose help explains it") {
  const auto problem = [](const std::vector<std::string>& words) -> std::string {
    CLI::App app("x", "isobar");
    add_replay_command(app);
    add_compare_command(app);
    try {
      app.parse(std::vector<std::string>(words.rbegin(), words.rend()));
    } catch (const CLI::ParseError& error) {
      return parse_problem(app, error);
    }
    return {};
  };
  CHECK(problem({"replay"}) == "RECORDING is required; `isobar replay --help` explains it");
  CHECK(problem({"compare", "a.toml", "b.toml", "--seeds", "1.5"}) ==
        "--seeds: \"1.5\" is no number that it takes; `isobar compare --help` explains it");
}

TEST_CASE(
    "a setting of the file that the recording replaces is named with its line; defaults and equal ones are "
    "not") {
  const LoadedConfig loaded = parse_layers(
      {{"robot.toml", "[lidar]\nmodel = \"VLP-16\"\nport = 2368\n[registration]\nmax_range_m = 50.0\n"}});
  Config used = loaded.config;
  used.lidar.model = "XT16";
  used.lidar.info_port = 9;  // no key of the file
  const std::vector<std::string> sentences = overridden_settings(loaded, used);
  REQUIRE(sentences.size() == 1);
  CHECK(sentences[0] == "robot.toml:2: lidar.model = \"VLP-16\" is not used: the recording has \"XT16\"");
}

}  // namespace isobar::test::test_typed_words
