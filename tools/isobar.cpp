// SPDX-License-Identifier: BSD-3-Clause
// `isobar`: the command-line tool. Exit codes: 0, 1 `check` has findings, 64 usage, 65 data, 69 service, 78 configuration.
#include <CLI/CLI.hpp>
#include <cstdio>
#include <exception>
#include <filesystem>
#include <string>
#include <vector>

#include "core/errors.hpp"
#include "tools/isobar_app.hpp"
#include "tools/typed_words.hpp"

namespace {

int run(int argc, char** argv) {
  CLI::App app;
  isobar::tools::add_all_commands(app);
  isobar::tools::check_typed_words(app, std::vector<std::string>(argv + 1, argv + argc));
  try {
    app.parse(argc, argv);
    return 0;
  } catch (const CLI::ParseError& error) {
    if (error.get_exit_code() != 0) throw isobar::UsageError(isobar::tools::parse_problem(app, error));
    app.exit(error);  // prints what was asked for: help or version
    return 0;
  }
}

}  // namespace

int main(int argc, char** argv) {
  // Line-buffered also in a pipe, so that its reader sees each line at once.
  std::setvbuf(stdout, nullptr, _IOLBF, 0);
  try {
    return run(argc, argv);
  } catch (const isobar::Error& error) {
    std::fprintf(stderr, "isobar: %s\n", error.what());
    return error.exit_code();
  } catch (const std::filesystem::filesystem_error& error) {
    std::fprintf(stderr, "isobar: %s: %s\n", error.path1().c_str(), error.code().message().c_str());
    return isobar::ServiceError("").exit_code();
  } catch (const std::exception& error) {
    std::fprintf(stderr, "isobar: unexpected: %s\n", error.what());
    return 70;
  }
}
